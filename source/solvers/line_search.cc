// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/line_search.h>

#include <cmath>

namespace Exemplar
{
  bool
  is_better(const Merit &now, const Merit &before, const double change_expected)
  {
    // near rounding the potential cannot tell any more, but the gradient can
    if (std::abs(change_expected) < 1e-9 * std::abs(before.potential))
      return now.potential <= before.potential + 1e-12 * std::abs(before.potential)
             && now.max_free_gradient < before.max_free_gradient;
    return now.potential <= before.potential + 1e-4 * change_expected; // Armijo
  }
} // namespace Exemplar
