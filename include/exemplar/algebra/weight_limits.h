// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_limits_h
#define exemplar_weight_limits_h

#include <utility>
#include <vector>

namespace Exemplar
{
  /// What keeps example weights, or changes of them, from going where the quadratic would have them:
  /// bounds w_i >= lower_i, and prices yields_i |w_i - kinks_i| that are added to the quadratic.
  struct WeightLimits
  {
    std::vector<double> lower; ///< empty: no bounds
    std::vector<double> kinks; ///< not below the bounds, which there must be then; empty: no prices
    std::vector<double> yields; ///< not negative

    WeightLimits() = default;

    /// Bounds alone.
    WeightLimits(std::vector<double> lower) : lower(std::move(lower)) {}
  };
} // namespace Exemplar

#endif
