// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/extent.h>
#include <exemplar/base/errors.h>
#include <exemplar/solvers/newton.h>
#include <exemplar/solvers/saddle.h>

#include <algorithm>
#include <cmath>

// A step of Newton's method: its direction, its length, and the way off a saddle point.

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int max_halvings_of_step = 30;
    constexpr double       max_step_length      = 64.;
  } // namespace

  double
  Newton::accuracy_of_step(const State &state, const Evaluation &evaluation) const
  {
    if (!system.iterates())
      return 0.;
    const Residual residual = potential.residual(state, evaluation);
    const double   r        = max_or_nan(residual.positions, residual.weights);
    // a step leaves some r^2 in any case, and less than the tolerance is not asked for
    return std::isfinite(r) && r > 0. ? std::max(std::min(1e-2, r), 0.1 * parameters.tolerance / r)
                                      : 0.;
  }

  bool
  Newton::find_step(const Trial      &trial,
                    const Evaluation &evaluation,
                    BorderedVector   &step,
                    SolveReport      &report)
  {
    const State &state = trial.state;
    // the least part of the convex tangent that makes the mixture definite
    for (const double convexity : { 0., 0.125, 0.5, 1. })
    {
      report.convexity = convexity;
      try
      {
        if (has_factor_of_step(trial))
          system.factorize_near(state.positions, state.weights, convexity);
        else
          system.factorize(state.positions, state.weights, convexity);
        step = system.solve(state, evaluation, accuracy_of_step(state, evaluation));
      }
      catch (const SolverFailure &failure)
      {
        report.failure = failure.what();
        continue; // indefinite
      }
      report.failure.clear();
      if (system.slope(evaluation, step) < 0.)
        return true;
    }
    report.status = report.failure.empty() ? SolveStatus::stalled : SolveStatus::indefinite;
    return false;
  }

  bool
  Newton::search_along(const BorderedVector &step,
                       State                &state,
                       Evaluation           &evaluation,
                       SolveReport          &report)
  {
    const State  start        = state;
    const Vector displacement = system.displacement(state, step);
    const double slope        = system.slope(evaluation, step);
    const Merit  before(potential, evaluation);
    const double longest           = potential.max_step(state.positions, displacement);
    const double longest_of_convex = std::min(max_step_length, longest);
    double      &length            = report.step_length;
    report.newton_decrement        = -0.5 * slope;
    const auto try_length          = [&](const double new_length)
    {
      length = new_length;
      state  = start;
      state.positions.add(length, displacement);
      evaluate(state, evaluation);
    };
    for (unsigned int halving = 0; halving < max_halvings_of_step; ++halving)
    {
      try_length(std::pow(0.5, halving) * std::min(1., longest));
      const Merit now(potential, evaluation);
      if (!is_better(now, before, length * slope)
          && !is_better_by_slopes(now, before, slope, system.slope(evaluation, step), length))
        continue;
      // the convex tangent is too stiff near a saddle: go on as long as it goes down
      double reached = evaluation.potential;
      while (report.convexity > 0. && length >= 1. && 2. * length <= longest_of_convex)
      {
        try_length(2. * length);
        const bool still_falls = is_below_rounding(before, slope)
                                     ? system.slope(evaluation, step) < 0.
                                     : evaluation.potential < reached;
        if (!still_falls)
        {
          try_length(0.5 * length);
          break;
        }
        reached = evaluation.potential;
      }
      return true;
    }
    state = start;
    evaluate(state, evaluation);
    if (report.convexity > 0. && leave_saddle(state, evaluation))
      return true;
    report.status = SolveStatus::stalled;
    return false;
  }

  bool
  Newton::leave_saddle(State &state, Evaluation &evaluation)
  {
    const State  start = state;
    const Merit  before(potential, evaluation);
    const Vector down = downward_curvature(system, potential, start);
    const double size = extent(start.positions, potential.get_free_dofs().exchange());
    for (const double length : { 1e-4 * size, -1e-4 * size, 1e-2 * size, -1e-2 * size })
    {
      if (down.size() == 0)
        break;
      state = start;
      state.positions.add(length, down);
      keep_within_max_step(potential, start.positions, state.positions);
      evaluate(state, evaluation);
      if (evaluation.potential < before.potential - 1e-12 * std::abs(before.potential))
        return true;
    }
    state = start;
    evaluate(state, evaluation);
    return false;
  }

  void
  Newton::go_on_with_same_factor(State &state, Evaluation &evaluation)
  {
    const double tolerance = parameters.tolerance;
    double       left      = 0.;
    while (!has_residual(tolerance, state, evaluation)
           && has_residual(tolerance / (left * left), state, evaluation))
      left = correct_with_same_factor(state, evaluation);
  }

  double
  Newton::correct_with_same_factor(State &state, Evaluation &evaluation)
  {
    const State    start = state;
    const Merit    before(potential, evaluation);
    BorderedVector step;
    try
    {
      step = system.solve(state, evaluation, accuracy_of_step(state, evaluation));
    }
    catch (const SolverFailure &)
    {
      return 1.; // for other active weights the Schur complement may be indefinite
    }
    const double slope = system.slope(evaluation, step);
    state.positions += system.displacement(state, step);
    keep_within_max_step(potential, start.positions, state.positions);
    evaluate(state, evaluation);
    const Merit  now(potential, evaluation);
    const double left = now.max_free_gradient / before.max_free_gradient;
    if (slope < 0. && left < 0.5 && is_better(now, before, slope))
      return left;
    state = start;
    evaluate(state, evaluation);
    return 1.;
  }
} // namespace Exemplar
