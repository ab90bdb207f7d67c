// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/time_integrator.h>

namespace Exemplar
{
  TimeIntegrator::TimeIntegrator(const TimeParameters &parameters)
      : scheme(parameters.scheme), mass_damping(parameters.mass_damping),
        stiffness_damping(parameters.stiffness_damping)
  {
  }

  void
  TimeIntegrator::begin_step(const State &state, const double step_size)
  {
    this->step_size = step_size;
    if (scheme == TimeScheme::bdf2 && state.previous_step > 0.)
    {
      // BDF2 for steps whose ratio is r; the first step is one of implicit Euler
      const double r = step_size / state.previous_step;
      gamma          = (1. + 2. * r) / ((1. + r) * step_size);
      c_last         = (1. + r) * (1. + r) / (1. + 2. * r);
      c_previous     = -r * r / (1. + 2. * r);
    }
    else
    {
      gamma      = 1. / step_size;
      c_last     = 1.;
      c_previous = 0.;
    }
    base = state.positions;
    if (c_previous != 0.)
      base.sadd(c_last, c_previous, state.previous_positions);
    const double time = 1. / (gamma + mass_damping);
    predicted         = base;
    if (c_previous == 0.)
      predicted.add(time, state.velocities);
    else
      predicted.add(time * c_last, state.velocities, time * c_previous, state.previous_velocities);
  }

  std::vector<WeightedPositions>
  TimeIntegrator::history(const State &state) const
  {
    std::vector<WeightedPositions> terms = { { c_last, &state.positions } };
    if (c_previous != 0.)
      terms.push_back({ c_previous, &state.previous_positions });
    return terms;
  }

  WeightStep
  TimeIntegrator::weight_step(const State &state) const
  {
    WeightStep step = { state.weights, state.weights, gamma, step_size };
    for (std::size_t i = 0; c_previous != 0. && i < step.base.size(); ++i)
      step.base[i] = c_last * state.weights[i] + c_previous * state.previous_weights[i];
    return step;
  }

  void
  TimeIntegrator::end_step(const State &old, State &state) const
  {
    state.velocities = state.positions;
    state.velocities -= base;
    state.velocities *= gamma;
    if (scheme == TimeScheme::bdf2)
    {
      state.previous_positions  = old.positions;
      state.previous_velocities = old.velocities;
      state.previous_weights    = old.weights;
      state.previous_step       = step_size;
    }
  }
} // namespace Exemplar
