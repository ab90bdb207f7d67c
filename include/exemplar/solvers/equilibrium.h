// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_equilibrium_h
#define exemplar_equilibrium_h

#include <exemplar/algebra/bordered_solver.h>
#include <exemplar/algebra/conditioning.h>
#include <exemplar/base/step_clock.h>
#include <exemplar/body/handles.h>
#include <exemplar/body/loads.h>
#include <exemplar/body/state.h>
#include <exemplar/potential/assembler.h>
#include <exemplar/potential/inertia.h>
#include <exemplar/solvers/quasi_newton_memory.h>
#include <exemplar/solvers/solver_parameters.h>
#include <exemplar/solvers/turned_factor.h>

#include <functional>
#include <string>
#include <vector>

namespace Exemplar
{
  enum class SolveStatus
  {
    initial,
    converged,
    one_pass,
    stalled,
    indefinite,
    iteration_limit,
    failed
  };

  /// The status as files and messages write it.
  std::string
  status_name(SolveStatus status);

  /// Whether a solve with this status has found the next state.
  inline bool
  is_success(const SolveStatus status)
  {
    return status == SolveStatus::converged || status == SolveStatus::one_pass;
  }

  /// How a solve ended.
  struct SolveReport
  {
    SolveStatus         status       = SolveStatus::initial;
    unsigned int        iterations   = 0;
    double              residual     = 0.; ///< relative, doc/method.md Eq. (13)
    double              kkt_residual = 0.; ///< of the weights, relative, Eq. (13)
    std::vector<double> residual_history;  ///< one entry an iteration
    double              step_length = 1.;  ///< of the last step, as the line search left it
    double              convexity   = 0.;  ///< of the last tangent: 0 exact, 1 convex
    std::string         failure;           ///< why, if the status is `failed` or `indefinite`
  };

  /// Finds positions and example weights at the end of a step: statics,
  /// interpolation and dynamics are one minimisation, and parts that a scene does
  /// not have are null.
  class Equilibrium
  {
  public:
    struct Parts
    {
      const FreeDofs               &free_dofs;
      const dealii::Vector<double> &rest_positions;
      Assembler                    &assembler;
      BorderedSolver               &linear_solver;
      StepClock                    &clock;
      const Handles                *handles;
      const Loads                  *loads;
      const ExamplePoses           *examples;
      Inertia                      *inertia;
      bool turns_freely; ///< the held degrees of freedom only make A regular
    };

    Equilibrium(const SolverParameters &parameters, const Parts &parts);

    /// Called after the evaluation of every iteration; for those who want to watch.
    std::function<void(const SolveReport &)> observe_iteration;

    /// Evaluate at a state that no solve has led to: before the first step, after a
    /// resume, and after a state was moved rigidly.
    void
    start(const State &state);

    /// Advance `state` to `time` by a step of length `step_size` (dynamics only) from
    /// where start() or the last solve evaluated. Unless the report says converged or
    /// one pass, `state` is not the solution. Throws Interrupted.
    SolveReport
    solve(State &state, double time, double step_size);

    /// Energies and internal forces at the state of start() or the last solve.
    const Evaluation &
    evaluation() const
    {
      return current;
    }

    /// The whole gradient there [N]: internal forces and inertia less loads. On held
    /// degrees of freedom it is the reaction.
    const dealii::Vector<double> &
    gradient() const
    {
      return total_gradient;
    }

    /// Half the square of x - x_hat that the last step minimised with the energy [J], Eq. (12);
    /// without damping and by implicit Euler |v_(n+1) - v_n|^2_M/2. 0 before the first step.
    double
    energy_of_inertia() const
    {
      return inertia_energy;
    }

    /// The next step must make its factor from the state alone, as after a resume.
    void
    forget_factor()
    {
      has_last_factor = false;
    }

    /// What a resumed run needs beside the state.
    const QuasiNewtonMemory &
    get_memory() const
    {
      return memory;
    }

    void
    restore(const QuasiNewtonMemory &earlier);

    /// Of what weights add to the linear systems: their columns and H; in bytes.
    std::size_t
    memory_of_weights() const;

    /// Of what the quasi-Newton method keeps; in bytes.
    std::size_t
    memory_of_quasi_newton() const;

    /// Of the systems that were solved last.
    Conditioning
    conditioning() const;

    /// Factorisations so far.
    unsigned int
    n_factorizations() const
    {
      return factorizations;
    }

  private:
    void
    begin_dynamic_step(const State &state, double step_size);

    void
    begin_step(State &state, double time);

    void
    move_handles(State &state);

    void
    update_loads(double time);

    void
    evaluate(const State               &state,
             Rotations                  rotations,
             const std::vector<double> *weight_target = nullptr);

    void
    add_inertia_and_loads(const State &state);

    /// Assemble A and, with weights to find, G, and factorise.
    void
    factorize(const dealii::Vector<double> &positions,
              const std::vector<double>    &weights,
              double                        convexity);

    /// Solve with the factor for the step that the gradients call for, into `unknowns`.
    void
    solve_for_step(const State &state);

    /// The solved step, by degree of freedom.
    dealii::Vector<double>
    solved_step(const State &state) const;

    /// Add the solved step.
    void
    add_step(State &state) const;

    SolveReport
    solve_by_passes(State &state, double time, double step_size);

    void
    begin_predicted_step(State &state, double time, double step_size);

    SolveReport
    solve_by_newton(State &state, double time, double step_size);

    bool
    advance_by_newton(State &state, double to, unsigned int halvings, SolveReport &report);

    void
    start_newton(const State &accepted, bool is_whole_step, State &trial);

    void
    predict_along_tangent(const State &accepted, State &trial);

    bool
    solve_for_prediction(const State                  &accepted,
                         const dealii::Vector<double> &displacement,
                         Tangent                       tangent);

    bool
    find_last_factor(const State &accepted);

    void
    iterate_newton(State &state, SolveReport &report);

    void
    take_newton_step(State &state, SolveReport &report);

    bool
    find_newton_step(const State &state, SolveReport &report);

    bool
    search_along_step(State &state, SolveReport &report);

    void
    correct_with_same_factor(State &state, SolveReport &report);

    void
    evaluate_with_best_weights(State &state, Rotations rotations = Rotations::update);

    /// A step by degree of freedom, and in the frame of the factor.
    struct QuasiNewtonStep
    {
      std::vector<double> direct, turned;
    };

    SolveReport
    solve_by_quasi_newton(State &state, double time, double step_size);

    void
    predict_positions(const State &accepted, double step_size, State &trial);

    void
    make_turned_factor(const State &state);

    void
    renew_turned_factor(const State &state);

    void
    find_turned_factor(const State &trial);

    void
    rebuild_turned_factor(const State &trial);

    double
    find_quasi_newton_step(const State               &trial,
                           const std::vector<double> &gradient,
                           QuasiNewtonStep           &step);

    bool
    take_quasi_newton_step(State                 &trial,
                           const QuasiNewtonStep &step,
                           double                 slope,
                           SolveReport           &report);

    void
    iterate_quasi_newton(const State &accepted, State &trial, SolveReport &report);

    void
    gather_free(const dealii::Vector<double> &field, std::vector<double> &free) const;

    void
    add_to_free(double                     factor,
                const std::vector<double> &free,
                dealii::Vector<double>    &field) const;

    double
    greatest_displacement(const State &from, const State &to) const;

    bool
    has_met_tolerance(const SolveReport &report) const;

    static bool
    is_better(double objective,
              double before,
              double change_expected,
              double gradient_norm,
              double gradient_norm_before);

    double
    greatest_free_gradient() const;

    double
    step_slope() const;

    double
    objective(const State &state) const;

    void
    measure(State &state, SolveReport &report) const;

    void
    measure_iteration(State &state, SolveReport &report) const;

    void
    measure_weights(State &state, SolveReport &report) const;

    SolverParameters       parameters;
    Parts                  parts;
    WeightBlock            block;
    BorderedVector         unknowns;
    Evaluation             current;
    dealii::Vector<double> total_gradient;
    dealii::Vector<double> force_scale; ///< a node, of the total gradient [N]
    dealii::Vector<double> external_force;
    dealii::Vector<double> external_force_norms;      ///< of each node
    double                 inertia_energy    = 0.;    ///< of the step [J]
    double                 current_objective = 0.;    ///< of Newton's method [J]
    bool                   dynamic_terms     = false; ///< within a step of a dynamic scene
    unsigned int           factorizations    = 0;
    bool                   has_last_factor   = false; ///< that of State::linearized_positions
    TurnedFactor           turned_factor;
    std::vector<float>     node_rotations;
    QuasiNewtonMemory      memory;
  };
} // namespace Exemplar

#endif
