// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/extent.h>

#include <algorithm>

namespace Exemplar
{
  double
  extent(const Vector &positions, const Exchange &exchange)
  {
    double maximum = 0.;
    for (unsigned int c = 0; c < 3; ++c)
    {
      double min = positions[c], max = positions[c];
      for (unsigned int dof = c; dof < positions.size(); dof += 3)
      {
        min = std::min(min, positions[dof]);
        max = std::max(max, positions[dof]);
      }
      maximum = std::max(maximum, exchange.max(max) - min_of_all(exchange, min));
    }
    return maximum;
  }
} // namespace Exemplar
