// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/extent.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/solvers/newton.h>

#include <algorithm>

// What a step does that does not converge: handles, loads and prescribed weights go half the way
// first, or forces are raised in stages.

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int max_halvings_of_increment = 6;

    /// As many times the maximum of iterations may be used by a step that cannot be halved.
    constexpr unsigned int patience  = 8;
    constexpr double       min_stage = 1e-12;

    bool
    has_stalled(const SolveReport &report)
    {
      return report.status == SolveStatus::stalled || report.status == SolveStatus::indefinite;
    }

    /// Do it; a SolverFailure becomes a status of the report.
    template <typename Work>
    void
    try_to(const Work &work, SolveReport &report)
    {
      report.status = SolveStatus::initial;
      try
      {
        work();
      }
      catch (const SolverFailure &failure)
      {
        report.status  = SolveStatus::failed;
        report.failure = failure.what();
      }
    }

    /// Lets go what it holds back, also where a step is interrupted.
    struct HoldBack
    {
      IncrementalPotential &potential;

      HoldBack(IncrementalPotential &potential, const Vector &gradient, const Vector &positions)
          : potential(potential)
      {
        potential.get_held_back().hold(potential.get_free_dofs(), gradient, positions);
      }
      ~HoldBack()
      {
        potential.get_held_back().let_go();
      }
    };

  } // namespace

  bool
  Newton::finish(Trial &trial, Evaluation &evaluation, const double time, SolveReport &report)
  {
    potential.set_time_of_terms(
        time); // so that friction may be renewed as often as in any solution
    // this trial is near, and what is left are renewals of friction, which take a few iterations each
    try_to([&] { iterate(patience * parameters.maximum_iterations, trial, evaluation, report); },
           report);
    return report.status == SolveStatus::converged;
  }

  bool
  Newton::advance(Trial             &start,
                  Evaluation        &evaluation,
                  const double       time,
                  const unsigned int halvings,
                  SolveReport       &report)
  {
    Trial trial    = start;
    bool  is_still = false, can_halve = false; // neither if its motions throw
    try_to(
        [&]
        {
          is_still = !potential.is_driven(start.state, time)
                     && !handles.are_elsewhere(time, start.state.positions);
          can_halve = !is_still && halvings < max_halvings_of_increment;
          predict(start, time, halvings == 0, trial, evaluation);
          iterate((can_halve ? 1 : patience) * parameters.maximum_iterations, trial, evaluation,
                  report);
        },
        report);
    if (report.status == SolveStatus::converged)
    {
      start = std::move(trial);
      return true;
    }
    start.linearization = {}; // the factor is that of a failed trial
    if (!can_halve)
      return is_still && has_stalled(report) && raise_forces(start, evaluation, time, report);
    // from the same state again, with half the way of handles, loads and weights
    const double middle = 0.5 * (start.state.time + time);
    return advance(start, evaluation, middle, halvings + 1, report)
           && advance(start, evaluation, time, halvings + 1, report);
  }

  bool
  Newton::raise_forces(Trial &start, Evaluation &evaluation, const double time, SolveReport &report)
  {
    const unsigned int maximum = patience * parameters.maximum_iterations;
    double             raised = 0., stage = 0.;
    try_to(
        [&]
        {
          potential.set_time(time, start.state);
          evaluate(start.state, evaluation);
          stage = first_stage(start, evaluation, report);
        },
        report);
    const HoldBack held(potential, evaluation.gradient, start.state.positions);
    while (raised < 1. && stage > min_stage && report.iterations < maximum)
    {
      const double to    = std::min(1., raised + stage);
      Trial        trial = start;
      potential.get_held_back().set_part(1. - to);
      try_to(
          [&]
          {
            evaluate(trial.state, evaluation);
            iterate(std::min(parameters.maximum_iterations, maximum - report.iterations), trial,
                    evaluation, report);
          },
          report);
      ++report.load_stages;
      if (report.status == SolveStatus::converged)
      {
        start  = std::move(trial);
        raised = to;
        stage *= 2.;
      }
      else
        stage /= 4.;
    }
    if (raised == 1.)
      return true;
    report.status
        = report.iterations < maximum ? SolveStatus::stalled : SolveStatus::iteration_limit;
    return false;
  }

  double
  Newton::first_stage(const Trial &start, const Evaluation &evaluation, SolveReport &report)
  {
    BorderedVector step;
    if (!find_step(start, evaluation, step, report))
      return 0.125;
    const Exchange &exchange = potential.get_free_dofs().exchange();
    const Vector    moved    = system.displacement(start.state, step);
    const double    maximum  = exchange.max(max_entry(moved.begin(), moved.end()));
    return std::min(1., 0.25 * extent(start.state.positions, exchange) / maximum);
  }
} // namespace Exemplar
