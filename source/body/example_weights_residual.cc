// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/body/example_weights.h>

#include <algorithm>
#include <limits>

// The KKT conditions of the weights.

namespace Exemplar
{
  namespace
  {
    /// Optimality condition of a weight: zero is between its one-sided derivatives plus the
    /// multiplier or, at the bound, not above the right one.
    struct Condition
    {
      WeightMemory::Slopes slopes;
      bool                 is_off; ///< whether the weight is off its bound

      bool
      is_free() const
      {
        return is_off && !(slopes.up > slopes.down);
      }

      double
      deviation(const double multiplier) const
      {
        const double up = slopes.up + multiplier, down = slopes.down + multiplier;
        if (is_free())
          return up;
        return std::max({ -up, is_off ? down : 0., 0. });
      }
    };

    /// The multiplier of a region: minus the mean derivative by its free weights; without free
    /// ones, the middle of the interval that the other weights' conditions allow.
    double
    multiplier_of(const std::vector<Condition> &region)
    {
      double       sum = 0., least = -std::numeric_limits<double>::infinity(), greatest = -least;
      unsigned int n = 0;
      for (const Condition &condition : region)
      {
        if (condition.is_free())
        {
          sum += condition.slopes.up;
          ++n;
        }
        least = std::max(least, -condition.slopes.up);
        if (condition.is_off)
          greatest = std::min(greatest, -condition.slopes.down);
      }
      return n > 0 ? -sum / n : 0.5 * (least + greatest);
    }
  } // namespace

  WeightResidual
  ExampleWeights::residual(const std::vector<double> &weights,
                           const std::vector<double> &gradient) const
  {
    const unsigned int k = n_per_region();
    WeightResidual     result;
    if (!held.empty()) // held weights need no optimality
    {
      result.multipliers.assign(form.N.m(), 0.);
      return result;
    }
    MaxMagnitude deviation;
    for (unsigned int region = 0; region < form.N.m(); ++region)
    {
      std::vector<Condition> conditions;
      for (unsigned int weight = region * k; weight < (region + 1) * k; ++weight)
        conditions.push_back({ memory.slopes(weight, weights[weight], gradient[weight]),
                               !bounded || weights[weight] > 0. });
      result.multipliers.push_back(multiplier_of(conditions));
      for (const Condition &condition : conditions)
        deviation.add(condition.deviation(result.multipliers.back()));
    }
    result.deviation = deviation.value();
    return result;
  }
} // namespace Exemplar
