// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_h
#define exemplar_problem_h

#include <exemplar/algebra/conditioning.h>
#include <exemplar/base/step_clock.h>
#include <exemplar/run/problem/laboratory.h>
#include <exemplar/run/problem/problem_parts.h>
#include <exemplar/run/problem/session_player.h>
#include <exemplar/run/problem/step_interval.h>
#include <exemplar/solvers/step_solver.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A scene made of its parts, in order of dependency. A part that the scene does
  /// not need is not there.
  class Problem
  {
  public:
    /// `inputs` are what read_inputs() gives, or arrays that a program hands in: then the scene
    /// needs no file. `clock` may run since the inputs are read. Throws UserError for whatever
    /// is no valid scene; writes nothing.
    Problem(const CompleteScene &scene, Inputs inputs, StepClock clock = StepClock(Phase::read));

    /// Of what the inputs have become, or of the part that this process has of them.
    Problem(const CompleteScene &scene, BodyInputs given, StepClock clock = StepClock(Phase::read));

    /// Solve the scene's next step from `state`, which is replaced if the solve succeeds; see next_step().
    SolveReport
    advance();

    /// The same for a step of another end and length, as step_of() and others give.
    SolveReport
    advance(const StepInterval &step);

    /// From the next step on `motion` moves a handle instead of its formulas. Throws UserError if
    /// no handle has this name.
    void
    set_motion(const std::string &handle, Motion motion);

    /// Between steps, let `change` change which nodes handles hold: hold(), let_go(), grab(). A
    /// degree of freedom that is let go keeps its velocity. Throws UserError, with nothing changed, for
    /// interpolations, and for what Constraints::change_handles() refuses. All processes must call this.
    void
    change_handles(const std::function<void(Handles &)> &change);

    /// Between steps, give the cells other constants. Patches stay those of the first ones. Throws
    /// UserError, with nothing changed, for numbers that Material::with() refuses. All processes must
    /// call this and the three functions below.
    void
    set_material(const ChangedConstants &changed);

    /// Between steps, give the examples another importance. Throws as check_importance().
    void
    set_importance(double importance);

    /// Throws UserError for a scene without examples, an interpolation, or a number that is not above 0 and at
    /// most 1.
    void
    check_importance(double importance) const;

    /// Between steps, let the weights of the examples be these from the next step on, of each region one after the
    /// other; empty: steps find them again. Throws UserError, with nothing changed, for what
    /// ExampleWeights::hold() refuses.
    void
    hold_weights(const std::vector<double> &weights);

    /// Between steps, let gravity be another [m/s^2]. Throws UserError for an interpolation.
    void
    set_gravity(const std::array<double, 3> &acceleration);

    /// Between steps, let these forces [N] act on the nodes of this process, by degree of freedom, beside
    /// other loads and with their Ramp; empty: none. Throws UserError for an interpolation.
    void
    set_nodal_forces(Vector forces);

    /// Between steps, let example i, counted as the weights, be at these places of the nodes [m]. Handles
    /// that follow a pose keep the first. Throws UserError, with nothing changed, for the rest pose, an
    /// example that is not there, and places that are no pose.
    void
    set_pose(unsigned int i, const std::vector<dealii::Point<3>> &places);

    /// Between steps, damp otherwise: mass damping [1/s] and stiffness damping [s]. Throws as check_damping().
    void
    set_damping(double mass_damping, double stiffness_damping);

    /// Throws UserError for a scene that is not dynamic, and for negative numbers.
    void
    check_damping(double mass_damping, double stiffness_damping) const;

    /// Between steps, let Phi have one more term, which is none of Psi. Throws whatever `make` throws,
    /// and UserError for an interpolation, with nothing changed. All processes must call this.
    void
    add_term(const MakeTerm &make);

    /// Where the potential is evaluated anywhere, between steps. Made when first asked for. Throws
    /// UserError where several processes share the body.
    Laboratory &
    laboratory();

    /// How often and by what function problem_changes.cc was last asked for another problem than that of
    /// the scene: steps before and after it are of two problems.
    struct Changes
    {
      unsigned int n = 0;
      std::string  last;

      /// `what` was changed, as messages call it.
      void
      count(const std::string &what)
      {
        ++n;
        last = what;
      }
    };

    /// Those since the problem was made; whoever remembers their number sees whether there were more.
    const Changes &
    get_changes() const
    {
      return changes;
    }

    /// Evaluate at a state that no step has led to.
    void
    start(State &at);

    /// Go on from a state of an earlier run.
    void
    resume_from(const State &earlier, const std::string &solver_memory = "");

    /// What the solver remembers beside the state, for resume_from().
    std::string
    solver_memory() const;

    /// What to tell the user of a step that advance() could not make: what happened in which step,
    /// and the remedy.
    std::string
    failure_message(const SolveReport &report) const;

    /// Of the systems that were solved last.
    Conditioning
    conditioning() const;

    /// Warnings of all parts.
    std::vector<std::string>
    warnings() const;

    CompleteScene                     parameters;
    StepClock                         clock;
    const TimeAxis                    time_axis;
    Body                              body;
    Constraints                       constraints;
    Examples                          examples;
    Actions                           actions;
    IncrementalPotential              potential;
    StepSystem                        system;
    const std::unique_ptr<StepSolver> solver;
    State                             state;
    Evaluation                        evaluation; ///< at the state

    /// Called after each step with the state from which it was made, and its length [s]; null: nothing is.
    std::function<void(const State &start, double size)> on_step;

  private:
    /// What is made of material, poses and importance is made anew, each from what it depends on.
    void
    follow_parameters();

    Changes                        changes;
    std::unique_ptr<Laboratory>    lab;     ///< null until it is asked for
    std::unique_ptr<SessionPlayer> session; ///< null unless the scene has one
  };

  /// Gives the body of a problem.
  using ReadBody = std::function<BodyInputs(const CompleteScene &)>;

  /// The problem of a scene and of what `read` gives for it. Throws UserError whatever fails, as
  /// the scene is to blame before the first step is solved.
  std::unique_ptr<Problem>
  make_problem(const CompleteScene &parameters, const ReadBody &read);

  /// The same with the files that the scene names. See read_inputs() for `announce`.
  std::unique_ptr<Problem>
  make_problem(const CompleteScene &parameters, const Announce &announce = {});
} // namespace Exemplar

#endif
