// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/rigid_modes.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  void
  center_and_scale(std::vector<double> &places, const Exchange &exchange)
  {
    const double n_nodes = exchange.sum(static_cast<double>(places.size() / 3));
    double       maximum = 0.;
    for (unsigned int c = 0; c < 3; ++c)
    {
      double sum = 0.;
      for (std::size_t row = c; row < places.size(); row += 3)
        sum += places[row];
      sum = exchange.sum(sum);
      for (std::size_t row = c; row < places.size(); row += 3)
      {
        places[row] -= sum / n_nodes;
        maximum = std::max(maximum, std::abs(places[row]));
      }
    }
    maximum = exchange.max(maximum);
    if (maximum > 0.)
      for (double &x : places)
        x /= maximum;
  }

  std::vector<double>
  rigid_modes(const std::vector<double> &places, const std::vector<int> &rows)
  {
    std::vector<double> modes(n_rigid_modes * places.size(), 0.);
    for (const int row : rows)
    {
      const int     c = row % 3;
      const double *x = places.data() + (row - c);
      const auto    set
          = [&](const int mode, const double value) { modes[mode * places.size() + row] = value; };
      set(c, 1.);
      set(3 + (c + 1) % 3, x[(c + 2) % 3]);
      set(3 + (c + 2) % 3, -x[(c + 1) % 3]);
    }
    return modes;
  }
} // namespace Exemplar
