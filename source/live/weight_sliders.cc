// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/weight_sliders.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace Exemplar::Live
{
  namespace
  {
    /// Greatest speed with which weights follow their sliders [1/s].
    constexpr double speed = 3.;

    SessionEvent
    held_at(const std::vector<double> &weights, const Problem &problem)
    {
      return { problem.state.step + 1, "weights", "", {}, weights };
    }
  } // namespace

  SessionEvent
  WeightSliders::want(const std::vector<double> &values, const Problem &problem)
  {
    const ExampleWeights &weights = problem.examples.weights;
    if (problem.parameters.examples.weights != WeightRule::simplex || weights.size() == 0)
      throw std::invalid_argument("this scene has no weights that steps find on the simplex");
    if (values.empty())
    {
      *this = {};
      return held_at({}, problem);
    }
    const double sum       = std::accumulate(values.begin(), values.end(), 0.);
    const auto   is_weight = [](const double weight) { return weight >= 0. && weight <= 1.; };
    if (values.size() != weights.n_per_region() || std::abs(sum - 1.) > 1e-6
        || !std::all_of(values.begin(), values.end(), is_weight))
      throw std::invalid_argument("weights are one an example, between 0 and 1, with the sum 1");
    if (at.empty())
      at = problem.state.weights;
    to.clear();
    for (unsigned int region = 0; region < weights.n_regions(); ++region)
      to.insert(to.end(), values.begin(), values.end());
    return held_at(at, problem);
  }

  Session
  WeightSliders::follow(const Problem &problem)
  {
    double farthest = 0.;
    for (std::size_t i = 0; i < to.size(); ++i)
      farthest = std::max(farthest, std::abs(to[i] - at[i]));
    if (farthest == 0.)
      return {};
    const double part = speed * problem.parameters.time.step / farthest;
    for (std::size_t i = 0; i < to.size(); ++i)
      at[i] = part < 1. ? at[i] + part * (to[i] - at[i]) : to[i];
    return { held_at(at, problem) };
  }
} // namespace Exemplar::Live
