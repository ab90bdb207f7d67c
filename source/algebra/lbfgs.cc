// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/lbfgs.h>
#include <exemplar/algebra/long_vectors.h>

#include <algorithm>
#include <iterator>

namespace Exemplar
{
  bool
  Lbfgs::add_pair(std::vector<double> &s, std::vector<double> &y)
  {
    const double curvature = exchange->sum(dot(s, y));
    if (!(curvature > 0.))
      return false;
    if (pairs.size() == max_pairs)
      drop_oldest();
    if (spare.empty())
      spare.emplace_back();
    pairs.push_back(std::move(spare.back()));
    spare.pop_back();
    Pair &newest = pairs.back();
    newest.s.swap(s);
    newest.y.swap(y);
    newest.rho = 1. / curvature;
    newest.inverse_y.clear();
    newest.products.clear();
    return true;
  }

  void
  Lbfgs::drop_oldest()
  {
    std::vector<Pair> &to = n_kept > 0 ? gone : spare;
    to.push_back(std::move(pairs.front()));
    pairs.erase(pairs.begin());
    n_kept -= n_kept > 0 ? 1 : 0;
  }

  void
  Lbfgs::clear()
  {
    while (!pairs.empty())
      drop_oldest();
    spare.clear();
  }

  void
  Lbfgs::keep()
  {
    n_kept = pairs.size();
    pairs.reserve(max_pairs);
    gone.reserve(max_pairs);
    spare.reserve(max_pairs + 1);
    for (Pair &pair : gone)
      if (spare.size() < max_pairs)
        spare.push_back(std::move(pair));
    gone.clear();
  }

  void
  Lbfgs::go_back()
  {
    pairs.erase(pairs.begin() + n_kept, pairs.end());
    pairs.insert(pairs.begin(), std::make_move_iterator(gone.begin()),
                 std::make_move_iterator(gone.end()));
    gone.clear();
    n_kept = pairs.size();
    for (Pair &pair : pairs)
    {
      pair.inverse_y.clear(); // by an inverse that may have been replaced
      pair.products.clear();
    }
  }

  std::size_t
  Lbfgs::memory_consumption() const
  {
    std::size_t bytes = 0;
    const auto  add   = [&](const auto &some)
    {
      for (const Pair &pair : some)
        bytes
            += sizeof(double) * (pair.s.capacity() + pair.y.capacity() + pair.inverse_y.capacity())
               + sizeof(double) * 2 * pair.products.capacity();
    };
    add(pairs);
    add(gone);
    add(spare);
    return bytes;
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

  LbfgsCorrection
  Lbfgs::correction(const std::function<void(std::vector<double> &)> &apply)
  {
    const std::size_t          k = pairs.size();
    LbfgsCorrection            correction;
    dealii::FullMatrix<double> R(k, k), middle(k, k);
    for (Pair &pair : pairs)
    {
      correction.columns.push_back(&pair.s);
      if (pair.inverse_y.empty())
      {
        pair.inverse_y = pair.y;
        apply(pair.inverse_y);
      }
    }
    for (std::size_t j = 0; j < k; ++j)
    {
      Pair &pair = pairs[j];
      correction.columns.push_back(&pair.inverse_y);
      for (std::size_t back = pair.products.size(); back <= j; ++back)
        pair.products.push_back({ exchange->sum(dot(pairs[j - back].s, pair.y)),
                                  exchange->sum(dot(pairs[j - back].y, pair.inverse_y)) });
      for (std::size_t i = 0; i <= j; ++i)
      {
        R(i, j)      = pair.products[j - i][0];
        middle(i, j) = middle(j, i) = pair.products[j - i][1];
      }
      middle(j, j) += R(j, j);
    }
    // R^-1, and R^-T (D + Y^T H0 Y) R^-1
    dealii::FullMatrix<double> inverse(k, k), product(k, k), corner(k, k);
    for (std::size_t j = 0; j < k; ++j)
      for (std::size_t i = j + 1; i-- > 0;)
      {
        double value = i == j ? 1. : 0.;
        for (std::size_t l = i + 1; l <= j; ++l)
          value -= R(i, l) * inverse(l, j);
        inverse(i, j) = value / R(i, i);
      }
    if (k > 0)
    {
      middle.mmult(product, inverse);
      inverse.Tmmult(corner, product);
    }
    correction.matrix.reinit(2 * k, 2 * k);
    for (std::size_t i = 0; i < k; ++i)
      for (std::size_t j = 0; j < k; ++j)
      {
        correction.matrix(i, j)     = corner(i, j);
        correction.matrix(i, k + j) = -inverse(j, i);
        correction.matrix(k + i, j) = -inverse(i, j);
      }
    return correction;
  }
} // namespace Exemplar
