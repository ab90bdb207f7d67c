// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/weight_memory.h>

#include <cmath>

namespace Exemplar
{
  WeightMemory::WeightMemory(std::vector<double> yields, std::vector<double> viscosities)
      : yield(std::move(yields)), viscosity(std::move(viscosities))
  {
  }

  void
  WeightMemory::add_to(WeightLimits &limits, const std::vector<double> &origin) const
  {
    if (!yields())
      return;
    limits.yields = yield;
    limits.kinks  = step.last;
    for (std::size_t i = 0; i < origin.size(); ++i)
      limits.kinks[i] -= origin[i];
  }

  void
  WeightMemory::snap(std::vector<double> &weights) const
  {
    constexpr double rounding = 1e-14;
    for (std::size_t i = 0; yields() && i < weights.size(); ++i)
      if (std::abs(weights[i] - step.last[i]) <= rounding)
        weights[i] = step.last[i];
  }

  double
  WeightMemory::energy(const std::vector<double> &weights) const
  {
    double sum = 0.;
    for (std::size_t i = 0; yields() && i < weights.size(); ++i)
      sum += yield[i] * std::abs(weights[i] - step.last[i]);
    for (std::size_t i = 0; creeps() && i < weights.size(); ++i)
      if (step.gamma > 0.)
        sum += 0.5 * force(i, weights[i]) * (weights[i] - step.base[i]);
    return sum;
  }

  double
  WeightMemory::force(const unsigned int i, const double weight) const
  {
    return stiffness(i) > 0. ? stiffness(i) * (weight - step.base[i]) : 0.;
  }

  void
  WeightMemory::add_linear_term(std::vector<double> &c) const
  {
    for (std::size_t i = 0; i < c.size(); ++i)
      if (stiffness(i) > 0.)
        c[i] += stiffness(i) * step.base[i];
  }

  WeightMemory::Slopes
  WeightMemory::slopes(const unsigned int i, const double weight, const double derivative) const
  {
    if (!yields())
      return { derivative, derivative };
    const double change = weight - step.last[i];
    return { derivative + (change >= 0. ? yield[i] : -yield[i]),
             derivative + (change > 0. ? yield[i] : -yield[i]) };
  }

  double
  WeightMemory::force_scale(const unsigned int i, const double weight) const
  {
    const bool has_moved = yields() && weight != step.last[i];
    return std::abs(force(i, weight)) + (has_moved ? yield[i] : 0.);
  }

  Dissipation
  WeightMemory::dissipation(const std::vector<double> &weights) const
  {
    Dissipation result;
    for (std::size_t i = 0; yields() && i < weights.size(); ++i)
      result.yield_of_weights += yield[i] * std::abs(weights[i] - step.last[i]);
    for (std::size_t i = 0; creeps() && i < weights.size(); ++i)
      if (step.gamma > 0.)
        result.creep_of_weights
            += viscosity[i] * std::pow(step.gamma * (weights[i] - step.base[i]), 2) * step.size;
    return result;
  }
} // namespace Exemplar
