// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/lbfgs.h>
#include <exemplar/algebra/long_vectors.h>

#include <algorithm>

namespace Exemplar
{
  void
  Lbfgs::add_pair(std::vector<double> &s, std::vector<double> &y)
  {
    const double curvature = exchange->sum(dot(s, y));
    if (!(curvature > 0.))
      return;
    if (pairs.size() == max_pairs)
      std::rotate(pairs.begin(), pairs.begin() + 1, pairs.end()); // the oldest becomes the newest
    else
      pairs.emplace_back();
    Pair &newest = pairs.back();
    newest.s.swap(s);
    newest.y.swap(y);
    newest.rho = 1. / curvature;
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
