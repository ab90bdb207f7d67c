// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_limits_h
#define exemplar_weight_limits_h

#include <utility>
#include <vector>

namespace Exemplar
{
  /// Limits on example weights, or on changes of them, in a quadratic program: bounds w_i >=
  /// lower_i, and terms yields_i |w_i - kinks_i| that are added to the objective.
  struct WeightLimits
  {
    std::vector<double> lower;  ///< empty: no bounds
    std::vector<double> kinks;  ///< >= lower, which must be given then; empty: no kinks
    std::vector<double> yields; ///< >= 0

    WeightLimits() = default;

    /// Bounds alone.
    WeightLimits(std::vector<double> lower) : lower(std::move(lower)) {}
  };
} // namespace Exemplar

#endif
