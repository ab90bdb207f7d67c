// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/interrupt.h>
#include <exemplar/solvers/equilibrium.h>

#include <algorithm>

// The paper's method: linear solves with frozen rotations, one a step or until nothing
// changes any more.

namespace Exemplar
{
  void
  Equilibrium::begin_step(State &state, const double time)
  {
    StepClock::Scope scope(parts.clock, Part::evaluate);
    state.time = time;
    update_loads(time);
    const bool prescribed = parts.examples != nullptr && parts.examples->weights_are_prescribed();
    if (prescribed)
      state.weights = parts.examples->prescribed_weights(time);
    if (prescribed || (dynamic_terms && parts.inertia->stiffness_damping_factor() > 0.))
      parts.assembler.evaluate(state.positions, state.weights, current);
    move_handles(state);
    add_inertia_and_loads(state);
  }

  void
  Equilibrium::move_handles(State &state)
  {
    // Only the cells beside held nodes feel that the handles move, and as long as the
    // rotations are frozen their forces are linear in the displacement.
    if (parts.handles == nullptr)
      return;
    const dealii::Vector<double> before       = state.positions;
    dealii::Vector<double>       displacement = before;
    parts.handles->move(state.time, state.positions);
    displacement.sadd(-1., 1., state.positions);
    parts.assembler.add_response_beside_held_nodes(Tangent::convex, displacement, before,
                                                   state.weights, current);
  }

  void
  Equilibrium::begin_predicted_step(State &state, const double time, const double step_size)
  {
    // forces with frozen rotations are linear in the positions: where a pass starts from does
    // not matter, but of where the rotations are does
    StepClock::Scope scope(parts.clock, Part::evaluate);
    const State      accepted = state;
    state.time                = time;
    update_loads(time);
    if (parts.examples != nullptr && parts.examples->weights_are_prescribed())
      state.weights = parts.examples->prescribed_weights(time);
    predict_positions(accepted, step_size, state);
    evaluate(state, RotationUse::update);
  }

  SolveReport
  Equilibrium::solve_by_passes(State &state, const double time, const double step_size)
  {
    SolveReport report;
    try
    {
      begin_dynamic_step(state, step_size);
      // if not predicted, the rotations are still those of the last accepted positions, before
      // the handles move: the paper's choice
      dealii::Vector<double> linearized_at = state.positions;
      if (parameters.rotations == PassRotations::last)
        begin_step(state, time);
      else
      {
        begin_predicted_step(state, time, step_size);
        linearized_at = state.positions;
      }
      while (report.status == SolveStatus::initial)
      {
        // a prediction has changed the memory by now, and checkpoints are of whole steps
        if (parameters.rotations == PassRotations::last)
          check_interrupt();
        factorize(linearized_at, state.weights, 1.);
        solve_for_step(state);
        add_step(state);
        linearized_at = state.positions;
        ++report.iterations;
        evaluate(state, RotationUse::update);
        measure_iteration(state, report);
        if (parameters.method == Method::one_pass)
          report.status = SolveStatus::one_pass;
        else if (has_met_tolerance(report))
          report.status = SolveStatus::converged;
        else if (report.iterations == parameters.maximum_iterations)
          report.status = SolveStatus::iteration_limit;
      }
    }
    catch (const SolverFailure &failure)
    {
      report.status  = SolveStatus::failed;
      report.failure = failure.what();
    }
    return report;
  }
} // namespace Exemplar
