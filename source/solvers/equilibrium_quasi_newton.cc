// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/solvers/equilibrium.h>

#include <algorithm>
#include <cmath>

// Steps of dynamics that seldom factorise: the exact gradient, and for the inverse of its
// derivative the factor of an earlier step, turned with the nodes and corrected by L-BFGS,
// whose pairs are kept in the frame of the factor and so stay good for many steps. Newton's
// method takes over where that does not converge. doc/method.md, "Steps without a factorisation".

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int most_iterations         = 7; ///< with one factor in a step
    constexpr unsigned int most_factors            = 2; ///< that a step may ask for
    constexpr unsigned int most_halvings           = 5;
    constexpr double       slowest_contraction     = 0.9;
    constexpr double       least_error_over_length = 1.2;
  } // namespace

  void
  Equilibrium::gather_free(const dealii::Vector<double> &field, std::vector<double> &free) const
  {
    const auto &list = parts.free_dofs.list();
    free.resize(list.size());
    for (std::size_t i = 0; i < list.size(); ++i)
      free[i] = field[list[i]];
  }

  void
  Equilibrium::add_to_free(const double               factor,
                           const std::vector<double> &free,
                           dealii::Vector<double>    &field) const
  {
    const auto &list = parts.free_dofs.list();
    for (std::size_t i = 0; i < list.size(); ++i)
      field[list[i]] += factor * free[i];
  }

  void
  Equilibrium::predict_positions(const State &accepted, const double step_size, State &trial)
  {
    std::vector<double> velocity;
    gather_free(accepted.velocities, velocity);
    memory.velocities.add(std::move(velocity));
    add_to_free(step_size, memory.velocities.next(), trial.positions);
    if (parts.handles != nullptr)
      parts.handles->move(trial.time, trial.positions);
  }

  void
  Equilibrium::make_turned_factor(const State &state)
  {
    factorize(state.positions, state.weights, 1.);
    StepClock::Scope scope(parts.clock, Part::factorize);
    parts.assembler.node_rotations(node_rotations);
    turned_factor.reinit(*parts.linear_solver.matrix(), block, node_rotations);
    turned_factor.turn(node_rotations);
  }

  void
  Equilibrium::renew_turned_factor(const State &state)
  {
    make_turned_factor(state);
    memory.factor_positions = state.positions;
    memory.factor_inertia   = parts.inertia->matrix_factor();
    memory.steps = memory.iterations = memory.last_iterations = 0;
    memory.lbfgs.clear();
  }

  void
  Equilibrium::find_turned_factor(const State &trial)
  {
    const bool is_due
        = memory.steps > 0
          && memory.last_iterations
                 > (turned_factor.cost_over_solve() + memory.iterations) / memory.steps;
    if (memory.factor_positions.size() == 0
        || memory.factor_inertia != parts.inertia->matrix_factor() || is_due)
      renew_turned_factor(trial);
    else
    {
      StepClock::Scope scope(parts.clock, Part::solve);
      parts.assembler.node_rotations(node_rotations);
      turned_factor.turn(node_rotations);
    }
  }

  void
  Equilibrium::rebuild_turned_factor(const State &trial)
  {
    // after a resume; rotations are functions of the positions
    if (memory.factor_positions.size() == 0 || !turned_factor.empty()
        || memory.factor_inertia != parts.inertia->matrix_factor())
      return;
    State then     = trial;
    then.positions = memory.factor_positions;
    parts.assembler.update_rotations(then.positions);
    make_turned_factor(then);
  }

  double
  Equilibrium::find_quasi_newton_step(const State               &trial,
                                      const std::vector<double> &gradient,
                                      QuasiNewtonStep           &step)
  {
    StepClock::Scope scope(parts.clock, Part::solve);
    step.turned = gradient;
    for (double &entry : step.turned)
      entry = -entry;
    turned_factor.turn_back(step.turned);
    if (block.H.m() > 0)
    {
      std::vector<double> lower;
      if (parts.examples->weights_are_bounded())
        for (const double weight : trial.weights)
          lower.push_back(-weight);
      turned_factor.add_example_forces(
          turned_factor.find_weight_changes(step.turned, current.weight_gradient, lower),
          step.turned);
    }
    memory.lbfgs.before(step.turned);
    turned_factor.solve(step.turned);
    memory.lbfgs.after(step.turned);
    step.direct = step.turned;
    turned_factor.turn_forth(step.direct);
    return dot(step.direct, gradient);
  }

  bool
  Equilibrium::take_quasi_newton_step(State                 &trial,
                                      const QuasiNewtonStep &step,
                                      const double           slope,
                                      SolveReport           &report)
  {
    const double before        = current_objective;
    const double gradient_norm = greatest_free_gradient();
    double      &length        = report.step_length;
    length                     = 1.;
    add_to_free(1., step.direct, trial.positions);
    for (unsigned int halving = 0;; ++halving)
    {
      evaluate_with_best_weights(trial, RotationUse::find_and_forget);
      if (is_better(current_objective, before, length * slope, greatest_free_gradient(),
                    gradient_norm))
        return true;
      if (halving == most_halvings)
      {
        add_to_free(-length, step.direct, trial.positions);
        return false;
      }
      length *= 0.5;
      add_to_free(-length, step.direct, trial.positions);
    }
  }

  double
  Equilibrium::greatest_displacement(const State &from, const State &to) const
  {
    double greatest = 0.;
    for (unsigned int dof = 0; dof < from.positions.size(); ++dof)
      greatest = std::max(greatest, std::abs(to.positions[dof] - from.positions[dof]));
    return greatest;
  }

  bool
  Equilibrium::has_met_tolerance(const SolveReport &report) const
  {
    return std::max(report.residual, report.kkt_residual) <= parameters.tolerance;
  }

  void
  Equilibrium::iterate_quasi_newton(const State &accepted, State &trial, SolveReport &report)
  {
    std::vector<double> gradient, change, weight_change;
    QuasiNewtonStep     step;
    double              last_length = 0., last_contraction = 0.;
    unsigned int        n_factors = 0, n_with_factor = 0;
    gather_free(total_gradient, gradient);
    while (!has_met_tolerance(report))
    {
      weight_change           = trial.weights;
      const double slope      = find_quasi_newton_step(trial, gradient, step);
      const bool   is_descent = n_with_factor < most_iterations && slope < 0.
                              && take_quasi_newton_step(trial, step, slope, report);
      if (!is_descent)
      {
        if (++n_factors > most_factors)
          return;
        if (n_with_factor < most_iterations) // the line search gave up, and went back
          evaluate_with_best_weights(trial);
        gather_free(total_gradient, gradient);
        renew_turned_factor(trial);
        n_with_factor = 0;
        continue;
      }
      ++report.iterations;
      ++n_with_factor;
      change.swap(gradient);
      gather_free(total_gradient, gradient);
      const double old_norm = std::sqrt(dot(change, change));
      const double ratio    = std::sqrt(dot(gradient, gradient)) / old_norm;
      {
        StepClock::Scope scope(parts.clock, Part::solve);
        for (std::size_t i = 0; i < change.size(); ++i)
        {
          change[i] = gradient[i] - change[i];
          step.turned[i] *= report.step_length;
        }
        turned_factor.turn_back(change);
        if (block.H.m() > 0)
        {
          for (std::size_t i = 0; i < weight_change.size(); ++i)
            weight_change[i] = trial.weights[i] - weight_change[i];
          turned_factor.add_example_forces(weight_change, change);
        }
        memory.lbfgs.add_pair(step.turned, change);
      }
      measure_iteration(trial, report);

      // what is left, were steps and gradients to go on shrinking as they did
      const double length      = report.step_length * greatest_entry(step.direct);
      const double contraction = std::min(
          std::max(ratio, last_length > 0. ? length / last_length : 0.), slowest_contraction);
      const double slower = std::max(contraction, last_contraction); // one alone may be luck
      last_length         = length;
      last_contraction    = contraction;
      const bool is_near  = length * std::max(least_error_over_length, slower / (1. - slower))
                           <= parameters.step_tolerance * greatest_displacement(accepted, trial);
      // of a stiff body, or one that is carried far, small errors of positions are large ones of
      // forces
      if (is_near && report.residual <= parameters.step_tolerance)
        break;
    }
    report.status = SolveStatus::converged;
  }

  SolveReport
  Equilibrium::solve_by_quasi_newton(State &state, const double time, const double step_size)
  {
    SolveReport report;
    begin_dynamic_step(state, step_size);
    State trial = state;
    trial.time  = time;
    try
    {
      {
        StepClock::Scope scope(parts.clock, Part::evaluate);
        update_loads(trial.time);
        if (parts.examples != nullptr && parts.examples->weights_are_prescribed())
          trial.weights = parts.examples->prescribed_weights(trial.time);
        predict_positions(state, step_size, trial);
        rebuild_turned_factor(trial);
        evaluate_with_best_weights(trial);
        measure_iteration(trial, report);
      }
      find_turned_factor(trial);
      iterate_quasi_newton(state, trial, report);
    }
    catch (const SolverFailure &failure)
    {
      report.failure = failure.what();
    }
    ++memory.steps;
    memory.iterations += report.iterations;
    memory.last_iterations = report.iterations;
    if (report.status == SolveStatus::converged)
    {
      std::swap(state, trial);
      return report;
    }
    memory.factor_positions.reinit(0);
    turned_factor.clear();
    advance_by_newton(state, time, 0, report);
    return report;
  }

  void
  Equilibrium::restore(const QuasiNewtonMemory &earlier)
  {
    memory = earlier;
    turned_factor.clear();
  }
} // namespace Exemplar
