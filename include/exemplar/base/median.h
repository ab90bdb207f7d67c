// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_median_h
#define exemplar_median_h

#include <algorithm>
#include <vector>

namespace Exemplar
{
  /// Median of at least one value.
  inline double
  median(std::vector<double> values)
  {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2.;
  }
} // namespace Exemplar

#endif
