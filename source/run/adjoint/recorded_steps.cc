// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/recorded_steps.h>
#include <exemplar/run/adjoint/trajectory_checks.h>

#include <fmt/core.h>

namespace Exemplar
{
  RecordedSteps::RecordedSteps(const Problem &problem)
      : initial(problem.state),
        has_two_steps(problem.parameters.scene == SceneKind::dynamic
                      && problem.parameters.time.scheme == TimeScheme::bdf2),
        n_changes(problem.get_changes().n)
  {
    require_known_steps(problem);
  }

  void
  RecordedSteps::add(const Problem &problem, const State &start, const double size)
  {
    const unsigned int i        = steps.size();
    const bool         is_first = i == 0;
    const Vector      &v        = is_first ? initial.velocities : steps.back().velocities;
    const double       time     = is_first ? initial.time : steps.back().time;
    // BDF2 uses two states before a step, so that the earlier one must be unchanged, too
    const bool has_its_past = !has_two_steps || is_first
                              || (start.previous_step == steps.back().size
                                  && start.previous_positions == positions_before(i - 1));
    if (start.positions != positions_before(i) || start.velocities != v || start.time != time
        || !has_its_past)
      broken = "its state was set";
    if (problem.get_changes().n != n_changes)
      broken = "it was changed by " + problem.get_changes().last;
    const State &end = problem.state;
    steps.push_back({ end.time, size, end.positions, end.velocities, end.weights });
  }

  void
  RecordedSteps::require_one_problem(const Problem &problem) const
  {
    if (!broken.empty())
      throw UserError(fmt::format("vjp: while the problem was recorded {}, and gradients are known "
                                  "for the steps of one problem alone. Record what comes after it.",
                                  broken));
    if (problem.get_changes().n != n_changes)
      throw UserError(fmt::format("vjp: since it was recorded the problem was changed by {}, so "
                                  "its steps would be others now. Record them anew.",
                                  problem.get_changes().last));
  }

  State
  RecordedSteps::start(const unsigned int i) const
  {
    if (i == 0)
      return initial;
    const RecordedStep &last  = steps[i - 1];
    State               state = initial;
    state.step                = initial.step + i;
    state.time                = last.time;
    state.positions           = last.positions;
    state.velocities          = last.velocities;
    state.weights             = last.weights;
    if (has_two_steps)
    {
      state.previous_positions  = positions_before(i - 1);
      state.previous_velocities = i == 1 ? initial.velocities : steps[i - 2].velocities;
      state.previous_weights    = i == 1 ? initial.weights : steps[i - 2].weights;
      state.previous_step       = last.size;
    }
    return state;
  }
} // namespace Exemplar
