// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/lbfgs.h>
#include <exemplar/algebra/long_vectors.h>

namespace Exemplar
{
  void
  Lbfgs::add_pair(const std::vector<double> &s, const std::vector<double> &y)
  {
    const double curvature = exchange->sum(dot(s, y));
    if (!(curvature > 0.))
      return;
    if (pairs.size() == max_pairs)
      pairs.pop_front();
    pairs.push_back({ s, y, 1. / curvature });
  }

  void
  Lbfgs::before(std::vector<double> &vector)
  {
    for (auto pair = pairs.rbegin(); pair != pairs.rend(); ++pair)
    {
      pair->alpha = pair->rho * exchange->sum(dot(pair->s, vector));
      add(vector, -pair->alpha, pair->y);
    }
  }

  void
  Lbfgs::after(std::vector<double> &vector) const
  {
    for (const Pair &pair : pairs)
      add(vector, pair.alpha - pair.rho * exchange->sum(dot(pair.y, vector)), pair.s);
  }
} // namespace Exemplar
