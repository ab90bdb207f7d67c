// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_limits_h
#define exemplar_weight_limits_h

#include <utility>
#include <vector>

namespace Exemplar
{
  /// Limits on example weights, or on changes of them, in a quadratic program: bounds lower_i <= w_i
  /// <= upper_i, and terms yields_i |w_i - kinks_i| that are added to the objective.
  struct WeightLimits
  {
    std::vector<double> lower; ///< empty: no bounds
    std::vector<double> upper; ///< >= lower, which must be given then; empty: no bounds from above
    std::vector<double>
        kinks; ///< between the bounds, of which lower must be given then; empty: none
    std::vector<double> yields; ///< >= 0

    WeightLimits() = default;

    /// Bounds from below alone.
    WeightLimits(std::vector<double> lower) : lower(std::move(lower)) {}
  };
} // namespace Exemplar

#endif
