// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_newton_h
#define exemplar_newton_h

#include <exemplar/solvers/line_search.h>
#include <exemplar/solvers/staged_motion.h>
#include <exemplar/solvers/step_path.h>
#include <exemplar/solvers/step_solver.h>

#include <limits>
#include <vector>

namespace Exemplar
{
  /// Newton's method on the potential as a function of the positions alone: the weights are the
  /// best ones at every evaluation. Steps come from the exact tangent; where that is indefinite,
  /// from a mixture with the convex one. A line search makes each a descent. Where a step does not
  /// converge, handles, loads and prescribed weights go half the way first. Where none of them
  /// moves, what acts on the body at the step's start is raised from nothing, in stages.
  class Newton : public StepSolver
  {
  public:
    Newton(const SolverParameters &parameters,
           IncrementalPotential   &potential,
           StepSystem             &system,
           const Handles          &handles,
           StepClock              &clock);

    SolveReport
    solve(State &state, Evaluation &evaluation, double time, double step_size) override;

    /// Solve a step that another method has begun, and continue its report. `reached` is a state at the end of the step to
    /// which that method has come, or null. The iterations start from it: a step in contact can have several equilibria, and
    /// this state is on the path of the motion. If they do not converge, the step starts again from `state`.
    void
    take_over(State       &state,
              const State *reached,
              Evaluation  &evaluation,
              double       time,
              SolveReport &report);

    void
    forget() override
    {
      accepted = {};
    }

    void
    save(boost::archive::binary_oarchive &archive) const override;

    void
    load(boost::archive::binary_iarchive &archive) override;

    const dealii::FullMatrix<double> &
    schur_complement() const override
    {
      return system.bordered().schur_complement();
    }

    std::size_t
    memory_consumption() const override;

  private:
    /// Where the last exact tangent was made. The next step starts near here, so its prediction reuses this factor.
    struct Linearization
    {
      static constexpr unsigned int not_made = std::numeric_limits<unsigned int>::max();

      Vector              positions; ///< empty: there is none
      std::vector<double> weights;
      std::vector<double> history;                ///< State::history at the beginning of its step
      double              time              = 0.; ///< of loads and tensions [s]
      double              time_of_obstacles = 0.; ///< they stood where they are then [s]
      unsigned int        factor            = not_made; ///< its number in StepSystem
    };

    /// A state on the way to that of the step's end.
    struct Trial
    {
      State         state;
      Linearization linearization;
      unsigned int  n_factors = 0; ///< how many the system had made when its step began
    };

    /// Whether the system's factor was made within the step, or as after a resume.
    bool
    has_factor_of_step(const Trial &trial) const;

    /// Iterate from a state at the end of the step; false, with an undefined `trial`, if that does not converge.
    bool
    finish(Trial &trial, Evaluation &evaluation, double time, SolveReport &report);

    bool
    advance(Trial       &start,
            Evaluation  &evaluation,
            double       time,
            unsigned int halvings,
            SolveReport &report);

    /// Go to `time` in stages, each the start of the next. In the first ones nearly all of the
    /// forces that are not in balance at `start` are held back. They are few where these forces
    /// move the body little.
    bool
    raise_forces(Trial &start, Evaluation &evaluation, double time, SolveReport &report);

    /// The part of its forces that would move the body by a quarter of its extent, were it linear.
    double
    first_stage(const Trial &start, const Evaluation &evaluation, SolveReport &report);

    /// Put `trial`, a copy of `start`, near its minimum at `time`.
    void
    predict(Trial &start, double time, bool is_whole_step, Trial &trial, Evaluation &evaluation);

    void
    predict_along_tangent(Trial &start, Trial &trial, Evaluation &evaluation);

    /// The step by which free nodes follow the held ones, with that tangent; false if the matrix
    /// is indefinite.
    bool
    add_tangent_step(Trial        &start,
                     const Vector &displacement,
                     Tangent       tangent,
                     Trial        &trial,
                     Evaluation   &evaluation);

    /// Whether a predicted body is far away, because weak springs alone resist what moves it.
    bool
    has_left(const Vector &from, const Vector &to) const;

    /// Whether the potential falls on the way, if cells remember what they have done: where they stop to yield, the
    /// factor of the last step, in which they yielded, takes a body much too far.
    bool
    is_descent_of_flow(const State &from, const State &to, Evaluation &evaluation);

    /// Add to the forces how they change while obstacles move from one time to another, extrapolated from a small part of this motion.
    /// Returns the time of this part, at which the obstacles are then: a barrier becomes stiffer as its gap closes, so
    /// that with the tangent of this time no body goes further than what pushes it.
    double
    add_motion_of_obstacles(const Vector &positions,
                            double        from_time,
                            double        time,
                            Evaluation   &evaluation);

    /// Have the factor of its linearization in the system; false if there is none. The terms are those of `time` [s].
    bool
    find_factor(Trial &start, double time);

    /// Make the factor of the linearization of `start` again, as after a resume.
    void
    remake_factor(Trial &start, double time);

    void
    iterate(unsigned int max_iterations, Trial &trial, Evaluation &evaluation, SolveReport &report);

    /// Whether the error of the positions in statics, estimated by a step with the last factor, is
    /// at most the tolerance, relative to the body's size. A small residual does not promise it.
    bool
    is_placed(const State &state, const Evaluation &evaluation);

    void
    take_step(Trial &trial, Evaluation &evaluation, SolveReport &report);

    /// How well a linear solver that iterates is to solve for the next step, as BorderedSystem::solve() has it: an inexact
    /// Newton method (S. Eisenstat and H. Walker, Choosing the forcing terms in an inexact Newton method, 1996).
    double
    accuracy_of_step(const State &state, const Evaluation &evaluation) const;

    bool
    find_step(const Trial      &trial,
              const Evaluation &evaluation,
              BorderedVector   &step,
              SolveReport      &report);

    /// The path of a step. In statics, where no inertia keeps steps short, a step that would close gaps becomes one that keeps
    /// them open: otherwise one gap would shorten the step of the whole body.
    StepPath
    path_of(BorderedVector &step, const State &state, const Evaluation &evaluation);

    bool
    search_along(BorderedVector &step, State &state, Evaluation &evaluation, SolveReport &report);

    /// Near a saddle point neither the potential nor the gradient tells which way is down, but the
    /// curvature does. False if it does not, or the potential does not fall there.
    bool
    leave_saddle(State &state, Evaluation &evaluation);

    /// One more step with the same factor from the new gradient (Shamanskii's method). Returns how
    /// much of the gradient it leaves, or 1 if that is more than half: then it is taken back.
    double
    correct_with_same_factor(State &state, Evaluation &evaluation);

    /// Such steps, as long as two more like the last would reach the tolerance.
    void
    go_on_with_same_factor(State &state, Evaluation &evaluation);

    /// With the best weights.
    void
    evaluate(State &state, Evaluation &evaluation);

    bool
    has_residual(double bound, const State &state, const Evaluation &evaluation) const;

    const SolverParameters parameters;
    IncrementalPotential  &potential;
    StepSystem            &system;
    const Handles         &handles;
    StepClock             &clock;
    StagedMotion           motion;
    Linearization          accepted;
  };
} // namespace Exemplar

#endif
