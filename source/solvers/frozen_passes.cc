// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/solvers/frozen_passes.h>
#include <exemplar/solvers/line_search.h>

#include <boost/serialization/deque.hpp>
#include <boost/serialization/vector.hpp>

namespace Exemplar
{
  FrozenPasses::FrozenPasses(const SolverParameters &parameters,
                             IncrementalPotential   &potential,
                             StepSystem             &system,
                             const Handles          &handles,
                             StepClock              &clock)
      : parameters(parameters), potential(potential), system(system), handles(handles),
        clock(clock), prediction(potential.get_free_dofs(), handles, parameters.prediction_order)
  {
  }

  void
  FrozenPasses::begin_with_last_rotations(const double time, State &trial, Evaluation &evaluation)
  {
    // the rotations are those of the last accepted positions, before the handles move: the
    // paper's choice
    StepClock::Scope scope(clock, Phase::evaluate);
    potential.set_time(time, trial);
    if (potential.changes_between_steps())
      potential.get_body().evaluate(trial.positions, trial.weights, evaluation.elastic);
    // Only the cells beside held nodes feel that the handles move, and as long as the
    // rotations are frozen their forces are linear in the displacement.
    if (handles.size() > 0)
    {
      const State from = trial;
      handles.move(time, trial.positions);
      Vector displacement = from.positions;
      displacement.sadd(-1., 1., trial.positions);
      potential.get_body().add_response(Tangent::convex, displacement, from.positions, from.weights,
                                        evaluation.elastic);
    }
    potential.add_terms(trial.positions, evaluation);
  }

  void
  FrozenPasses::begin_with_predicted_rotations(const State &accepted,
                                               const double time,
                                               const double step_size,
                                               State       &trial,
                                               Evaluation  &evaluation)
  {
    // forces with frozen rotations are linear in the positions: where a pass starts from does
    // not matter, but of where the rotations are does
    StepClock::Scope scope(clock, Phase::evaluate);
    potential.set_time(time, trial);
    prediction.predict(accepted, step_size, trial);
    keep_within_max_step(potential, accepted.positions, trial.positions);
    potential.evaluate(trial, RotationUse::update, evaluation);
  }

  void
  FrozenPasses::iterate(const Vector &linearized_at,
                        State        &trial,
                        Evaluation   &evaluation,
                        SolveReport  &report)
  {
    system.factorize(linearized_at, trial.weights, 1.);
    const Vector from = trial.positions;
    system.add(system.solve(trial, evaluation), trial);
    keep_within_max_step(potential, from, trial.positions);
    ++report.iterations;
    {
      StepClock::Scope scope(clock, Phase::evaluate);
      potential.evaluate(trial, RotationUse::update, evaluation);
    }
    const bool is_same = potential.renew(trial, evaluation, true) == TermChange::none;
    const bool goes_on = report_iteration(potential, evaluation, trial, report);
    if (parameters.method == Method::one_pass)
      report.status = SolveStatus::one_pass;
    else if (is_same && has_met(parameters.tolerance, report))
      report.status = SolveStatus::converged;
    else if (report.iterations == parameters.maximum_iterations)
      report.status = SolveStatus::iteration_limit;
    else if (!goes_on)
      throw Interrupted("Interrupted.");
  }

  SolveReport
  FrozenPasses::solve(State       &state,
                      Evaluation  &evaluation,
                      const double time,
                      const double step_size)
  {
    SolveReport report;
    State       trial = state;
    try
    {
      potential.begin_step(state, step_size);
      Vector linearized_at = state.positions;
      if (has_predicted_rotations())
      {
        begin_with_predicted_rotations(state, time, step_size, trial, evaluation);
        linearized_at = trial.positions;
      }
      else
        begin_with_last_rotations(time, trial, evaluation);
      while (report.status == SolveStatus::initial)
      {
        iterate(linearized_at, trial, evaluation, report);
        linearized_at = trial.positions;
      }
    }
    catch (const SolverFailure &failure)
    {
      report.status  = SolveStatus::failed;
      report.failure = failure.what();
    }
    catch (const Interrupted &)
    {
      if (has_predicted_rotations())
        prediction.take_back();
      throw;
    }
    if (is_success(report.status))
      state = std::move(trial);
    return report;
  }

  void
  FrozenPasses::save(boost::archive::binary_oarchive &archive) const
  {
    prediction.save(archive);
  }

  void
  FrozenPasses::load(boost::archive::binary_iarchive &archive)
  {
    prediction.load(archive);
  }
} // namespace Exemplar
