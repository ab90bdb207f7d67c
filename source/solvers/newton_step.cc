// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/extent.h>
#include <exemplar/algebra/long_vectors.h>
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
    constexpr unsigned int max_halvings_of_step        = 30;
    constexpr double       max_step_length             = 64.;
    constexpr double       max_displacement_in_contact = 0.25; ///< of the body's extent
  }                                                            // namespace

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

  StepPath
  Newton::path_of(BorderedVector &step, const State &state, const Evaluation &evaluation)
  {
    const FreeDofs                 &free_dofs  = potential.get_free_dofs();
    const std::vector<unsigned int> pieces     = potential.inertial_positions() == nullptr
                                                     ? potential.weakly_constrained_pieces()
                                                     : std::vector<unsigned int>();
    const auto                      path_along = [&](const Vector &displacement)
    { return StepPath(state.positions, displacement, pieces, free_dofs); };
    Vector     displacement = system.displacement(state, step);
    StepPath   path         = path_along(displacement);
    const auto closes
        = [&](const Vector &way) { return potential.max_step(state.positions, way) < 1.; };
    if (potential.inertial_positions() != nullptr || potential.gap_width() == 0.
        || system.iterates() || !closes(path.way(1.)))
      return path;
    const auto open = [&](Vector &way)
    {
      motion.keep_open(state.time, state.positions, way,
                       [&](std::vector<double> &forces)
                       { system.bordered().apply_inverse(forces); });
    };
    const double allowed
        = max_displacement_in_contact * extent(state.positions, free_dofs.exchange());
    const double greatest
        = free_dofs.exchange().max(max_entry(displacement.begin(), displacement.end()));
    if (greatest > allowed) // springs that hold a whole body are soft
      displacement *= allowed / greatest;
    open(displacement);
    BorderedVector opened = step;
    for (std::size_t i = 0; i < free_dofs.list().size(); ++i)
      opened.positions[i] = displacement[free_dofs.list()[i]];
    if (!(system.slope(evaluation, opened) < 0.))
      return path;
    step                   = std::move(opened);
    StepPath     open_path = path_along(displacement);
    const Vector end       = open_path.way(1.);
    if (closes(end)) // because it turns
    {
      Vector bent = end;
      open(bent);
      bent -= end;
      open_path.bend(bent);
    }
    return open_path;
  }

  bool
  Newton::search_along(BorderedVector &step,
                       State          &state,
                       Evaluation     &evaluation,
                       SolveReport    &report)
  {
    const State start       = state;
    report.newton_decrement = -0.5 * system.slope(evaluation, step);
    const StepPath path     = path_of(step, state, evaluation);
    const double   slope    = system.slope(evaluation, step);
    const Merit    before(potential, evaluation);
    const double   longest           = potential.max_step(state.positions, path.way(1.));
    const double   longest_of_convex = path.is_straight() ? std::min(max_step_length, longest) : 1.;
    double        &length            = report.step_length;
    const auto     try_length        = [&](const double new_length)
    {
      length          = new_length;
      state           = start;
      state.positions = path.at(length);
      evaluate(state, evaluation);
    };
    for (unsigned int halving = 0; halving < max_halvings_of_step; ++halving)
    {
      const double part = std::pow(0.5, halving) * std::min(1., longest);
      if (!path.is_straight() && potential.max_step(start.positions, path.way(part)) < 1.)
        continue;
      try_length(part);
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
