// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/problem/problem.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    constexpr double rounding = 1e-9; ///< in parts of a step

    bool
    is_dynamic(const Problem &problem)
    {
      return problem.parameters.scene == SceneKind::dynamic;
    }

    bool
    is_on_axis(const Problem &problem)
    {
      const State &state = problem.state;
      return state.step < problem.time_axis.n_steps()
             && state.time == problem.time_axis.time(state.step);
    }
  } // namespace

  StepInterval
  next_step(const Problem &problem)
  {
    const TimeAxis &axis  = problem.time_axis;
    const State    &state = problem.state;
    if (is_on_axis(problem))
      return { axis.time(state.step + 1), axis.step_size(state.step + 1) };
    const double size = axis.step_size(1);
    if (is_dynamic(problem) || state.time + size * (1. + rounding) < 1.)
      return { state.time + size, size };
    return { 1., std::max(0., 1. - state.time) };
  }

  StepInterval
  step_of(const Problem &problem, const double size)
  {
    if (!(size > 0. && std::isfinite(size)))
      throw UserError(fmt::format("A step of {} s is none. Its length must be a number above 0.",
                                  short_text(size)));
    const StepInterval next = next_step(problem);
    if (size == next.size)
      return next;
    const double end = problem.state.time + size;
    if (!is_dynamic(problem) && end > 1. + rounding * size)
      throw UserError(fmt::format("A step of {} from t = {} leads beyond t = 1, where a scene ends "
                                  "that is not dynamic. Take a shorter one.",
                                  shortest_text(size), shortest_text(problem.state.time)));
    if (!(end > problem.state.time))
      throw UserError(fmt::format("A step of {} s is nothing beside t = {} s. Take a longer one.",
                                  shortest_text(size), shortest_text(problem.state.time)));
    return { is_dynamic(problem) ? end : std::min(end, 1.), size };
  }

  StepInterval
  step_towards(const Problem &problem, const double time)
  {
    const StepInterval next = next_step(problem);
    if (next.end < time + rounding * next.size)
      return next;
    return { time, time - problem.state.time };
  }

  bool
  has_reached(const Problem &problem, const double time)
  {
    return problem.state.time >= time - rounding * problem.time_axis.step_size(1);
  }

  double
  end_of_scene(const Problem &problem)
  {
    return problem.time_axis.time(problem.time_axis.n_steps());
  }

  void
  check_weights(const Problem &problem, const StepInterval &step)
  {
    const ExampleWeights &weights = problem.examples.weights;
    if (!weights.are_prescribed()
        || (is_on_axis(problem) && step.end == problem.time_axis.time(problem.state.step + 1)))
      return;
    weights.check_sums(step.end);
  }
} // namespace Exemplar
