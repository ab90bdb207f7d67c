// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/weight_qp.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/interrupt.h>
#include <exemplar/solvers/equilibrium.h>

#include <cmath>
#include <numeric>

// Newton's method on the energy as a function of the positions alone: the weights are
// the best ones at every evaluation. Steps come from the exact tangent; where that is
// indefinite, from the convex one. A line search makes each a descent.

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int most_halvings_of_increment = 6;
    constexpr unsigned int most_halvings_of_step      = 30;
    constexpr double       greatest_length            = 64.;
  } // namespace

  bool
  Equilibrium::is_better(const double objective,
                         const double before,
                         const double change_expected, // < 0
                         const double gradient_norm,
                         const double gradient_norm_before)
  {
    // near rounding the objective cannot tell any more, but the gradient can
    if (std::abs(change_expected) < 1e-9 * std::abs(before))
      return objective <= before + 1e-12 * std::abs(before) && gradient_norm < gradient_norm_before;
    return objective <= before + 1e-4 * change_expected; // Armijo
  }

  double
  Equilibrium::objective(const State &state) const
  {
    double value = current.energy + current.energy_damping;
    if (dynamic_terms)
      value += inertia_energy;
    if (parts.loads != nullptr)
    {
      // of displacements: from positions the work would come with rounding of its own
      dealii::Vector<double> displacement = state.positions;
      displacement -= parts.rest_positions;
      value -= external_force * displacement;
    }
    return value;
  }

  void
  Equilibrium::evaluate_with_best_weights(State &state, const RotationUse rotations)
  {
    StepClock::Scope scope(parts.clock, Part::evaluate);
    if (block.H.m() > 0)
    {
      const std::vector<double> target
          = parts.assembler.weight_linear_term(state.positions, RotationUse::update);
      const std::vector<double> lower(
          parts.examples->weights_are_bounded() ? state.weights.size() : 0, 0.);
      const std::vector<double> sums(parts.examples->n_regions(), 1.);
      const WeightQpSolution    best
          = minimize_over_weights(block.H, target, sums, lower, state.weights);
      if (!best.found)
        throw SolverFailure("The example weights are not determined. Set Examples/Weight penalty "
                            "to auto.");
      state.weights = best.weights;
      evaluate(state, RotationUse::keep, &target);
    }
    else
      evaluate(state, rotations);
    current_objective = objective(state);
  }

  double
  Equilibrium::step_slope() const
  {
    const auto &free  = parts.free_dofs.list();
    double      slope = 0.;
    for (unsigned int i = 0; i < free.size(); ++i)
      slope += total_gradient[free[i]] * unknowns.positions[i];
    return slope;
  }

  double
  Equilibrium::greatest_free_gradient() const
  {
    double greatest = 0.;
    for (const unsigned int dof : parts.free_dofs.list())
      greatest = std::max(greatest, std::abs(total_gradient[dof]));
    return greatest;
  }

  bool
  Equilibrium::find_newton_step(const State &state, SolveReport &report)
  {
    // between the two the least convex part that does
    for (const double convexity : { 0., 0.125, 0.5, 1. })
    {
      report.convexity = convexity;
      try
      {
        factorize(state.positions, state.weights, convexity);
        solve_for_step(state);
      }
      catch (const SolverFailure &failure)
      {
        report.failure = failure.what();
        continue; // indefinite
      }
      report.failure.clear();
      if (step_slope() < 0.)
        return true;
    }
    report.status = report.failure.empty() ? SolveStatus::stalled : SolveStatus::indefinite;
    return false;
  }

  bool
  Equilibrium::search_along_step(State &state, SolveReport &report)
  {
    const State                  start         = state;
    const dealii::Vector<double> step          = solved_step(state);
    const double                 slope         = step_slope();
    const double                 before        = current_objective;
    const double                 gradient_norm = greatest_free_gradient();
    double                      &length        = report.step_length;
    const auto                   try_length    = [&](const double new_length)
    {
      length = new_length;
      state  = start;
      state.positions.add(length, step);
      evaluate_with_best_weights(state);
    };
    for (unsigned int halving = 0; halving < most_halvings_of_step; ++halving)
    {
      try_length(std::pow(0.5, halving));
      if (!is_better(current_objective, before, length * slope, greatest_free_gradient(),
                     gradient_norm))
        continue;
      // the convex tangent is too stiff near a saddle: go on as long as it goes down
      double reached = current_objective;
      while (report.convexity > 0. && length >= 1. && length < greatest_length)
      {
        try_length(2. * length);
        if (!(current_objective < reached))
        {
          try_length(0.5 * length);
          break;
        }
        reached = current_objective;
      }
      return true;
    }
    state = start;
    evaluate_with_best_weights(state);
    report.status = SolveStatus::stalled;
    return false;
  }

  void
  Equilibrium::correct_with_same_factor(State &state, SolveReport &report)
  {
    measure(state, report);
    if (has_met_tolerance(report))
      return;
    const State  start         = state;
    const double before        = current_objective;
    const double gradient_norm = greatest_free_gradient();
    try
    {
      solve_for_step(state);
    }
    catch (const SolverFailure &)
    {
      return; // for other active weights the complement may be indefinite
    }
    const double slope = step_slope();
    state.positions += solved_step(state);
    evaluate_with_best_weights(state);
    if (slope < 0. && greatest_free_gradient() < 0.5 * gradient_norm
        && is_better(current_objective, before, slope, greatest_free_gradient(), gradient_norm))
      return;
    state = start;
    evaluate_with_best_weights(state);
  }

  void
  Equilibrium::start_newton(const State &accepted, const bool is_whole_step, State &trial)
  {
    StepClock::Scope scope(parts.clock, Part::evaluate);
    update_loads(trial.time);
    if (parts.examples != nullptr && parts.examples->weights_are_prescribed())
      trial.weights = parts.examples->prescribed_weights(trial.time);
    if (dynamic_terms && is_whole_step)
    {
      // inertia predicts better than any tangent: x + h v
      for (const unsigned int dof : parts.free_dofs.list())
        trial.positions[dof] = parts.inertia->predicted_positions()[dof];
      if (parts.handles != nullptr)
        parts.handles->move(trial.time, trial.positions);
      return;
    }
    predict_along_tangent(accepted, trial);
  }

  bool
  Equilibrium::find_last_factor(const State &accepted)
  {
    // the exact tangent of the last iteration is next to that of the accepted state; a
    // resumed run makes it anew
    if (accepted.linearized_positions.size() == 0)
      return false;
    if (!has_last_factor)
    {
      parts.assembler.update_rotations(accepted.linearized_positions);
      factorize(accepted.linearized_positions, accepted.linearized_weights, 0.);
      try
      {
        solve_for_step(accepted); // as then: the columns Z beside a right side
      }
      catch (const SolverFailure &)
      {
      } // Z is there, and for the weights of this right side nobody asked
      has_last_factor = true;
    }
    return true;
  }

  bool
  Equilibrium::solve_for_prediction(const State                  &accepted,
                                    const dealii::Vector<double> &displacement,
                                    const Tangent                 tangent)
  {
    try
    {
      const bool has_factor = tangent == Tangent::exact && find_last_factor(accepted);
      parts.assembler.update_rotations(accepted.positions);
      parts.assembler.evaluate(accepted.positions, accepted.weights, current);
      parts.assembler.add_response_beside_held_nodes(tangent, displacement, accepted.positions,
                                                     accepted.weights, current);
      add_inertia_and_loads(accepted);
      if (!has_factor)
        factorize(accepted.positions, accepted.weights, tangent == Tangent::convex ? 1. : 0.);
      solve_for_step(accepted);
      return true;
    }
    catch (const SolverFailure &)
    {
      return false; // indefinite
    }
  }

  void
  Equilibrium::predict_along_tangent(const State &accepted, State &trial)
  {
    // so that free nodes move with the handles instead of being crushed by them
    if (parts.handles != nullptr)
      parts.handles->move(trial.time, trial.positions);
    dealii::Vector<double> displacement = trial.positions;
    displacement -= accepted.positions;
    State at   = accepted;
    at.weights = trial.weights; // prescribed ones are those of the new time
    if (solve_for_prediction(at, displacement, Tangent::exact)
        || solve_for_prediction(at, displacement, Tangent::convex))
      add_step(trial);
  }

  void
  Equilibrium::iterate_newton(State &state, SolveReport &report)
  {
    evaluate_with_best_weights(state);
    for (unsigned int iteration = 0;; ++iteration)
    {
      // a quasi-Newton step has changed its memory by now, and the checkpoint of an interrupted
      // run must be that of whole steps
      if (parameters.method == Method::newton)
        check_interrupt();
      measure_iteration(state, report);
      if (has_met_tolerance(report))
        report.status = SolveStatus::converged;
      else if (iteration == parameters.maximum_iterations)
        report.status = SolveStatus::iteration_limit;
      else
        take_newton_step(state, report);
      if (report.status != SolveStatus::initial)
        return;
      ++report.iterations;
    }
  }

  void
  Equilibrium::take_newton_step(State &state, SolveReport &report)
  {
    dealii::Vector<double> positions = state.positions;
    std::vector<double>    weights   = state.weights;
    if (!find_newton_step(state, report) || !search_along_step(state, report))
      return;
    correct_with_same_factor(state, report);
    // what the factor is of, if the next step may predict with it
    has_last_factor = !dynamic_terms && report.convexity == 0.;
    if (!has_last_factor)
      positions.reinit(0);
    state.linearized_positions = std::move(positions);
    state.linearized_weights   = std::move(weights);
  }

  bool
  Equilibrium::advance_by_newton(State             &state,
                                 const double       to,
                                 const unsigned int halvings,
                                 SolveReport       &report)
  {
    State trial   = state;
    trial.time    = to;
    report.status = SolveStatus::initial;
    try
    {
      start_newton(state, halvings == 0, trial);
      iterate_newton(trial, report);
    }
    catch (const SolverFailure &failure)
    {
      report.status  = SolveStatus::failed;
      report.failure = failure.what();
    }
    if (report.status == SolveStatus::converged)
    {
      state = trial;
      return true;
    }
    state.linearized_positions.reinit(0); // the factor is that of a failed trial
    if (halvings == most_halvings_of_increment)
      return false;
    // from the accepted state again, with half the way of handles, loads and weights
    const double middle = 0.5 * (state.time + to);
    return advance_by_newton(state, middle, halvings + 1, report)
           && advance_by_newton(state, to, halvings + 1, report);
  }

  SolveReport
  Equilibrium::solve_by_newton(State &state, const double time, const double step_size)
  {
    SolveReport report;
    begin_dynamic_step(state, step_size);
    advance_by_newton(state, time, 0, report);
    return report;
  }
} // namespace Exemplar
