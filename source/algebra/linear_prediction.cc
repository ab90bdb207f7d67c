// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>
#include <exemplar/algebra/linear_prediction.h>
#include <exemplar/algebra/long_vectors.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Ridge relative to the trace of the normal equations, so small that it matters only where
    /// they are singular.
    constexpr double ridge = 1e-10;

    /// Greatest norm of the next vector relative to the last. When a body at rest is first pulled,
    /// the ratio of two velocities is that of a motion to rounding.
    constexpr double max_growth = 4.;
  } // namespace

  void
  LinearPrediction::multiply_out(const std::size_t i)
  {
    for (std::size_t j = i; j < history.size(); ++j)
      products[i][j] = exchange->sum(dot(history[i], history[j]));
  }

  void
  LinearPrediction::restore(std::deque<std::vector<double>> vectors)
  {
    history = std::move(vectors);
    if (history.size() > order + 1) // left over from a higher order
      history.resize(order + 1);
    for (std::size_t i = history.size(); i-- > 0;)
      multiply_out(i);
  }

  void
  LinearPrediction::add(std::vector<double> &vector)
  {
    has_left = history.size() == order + 1;
    if (has_left)
      left.swap(history.back());
    else
      history.emplace_back();
    std::rotate(history.begin(), history.end() - 1, history.end());
    history.front().swap(vector);
    for (std::size_t i = history.size() - 1; i > 0; --i)
      for (std::size_t j = i; j < history.size(); ++j)
        products[i][j] = products[i - 1][j - 1];
    multiply_out(0);
  }

  void
  LinearPrediction::take_back()
  {
    std::rotate(history.begin(), history.begin() + 1, history.end());
    if (has_left)
      history.back().swap(left);
    else
      history.pop_back();
    for (std::size_t i = history.size(); i-- > 0;)
      multiply_out(i);
  }

  bool
  LinearPrediction::find_coefficients()
  {
    const unsigned int m = history.size() - 1;
    gram.reinit(m, m);
    coefficients.resize(m);
    for (unsigned int i = 0; i < m; ++i)
    {
      coefficients[i] = products[0][i + 1];
      for (unsigned int j = 0; j <= i; ++j)
        gram(i, j) = products[j + 1][i + 1];
    }
    if (m == 0)
      return false;
    const double trace = gram.trace();
    for (unsigned int i = 0; i < m; ++i)
      gram(i, i) += ridge * trace;
    return solve_by_cholesky(gram, coefficients);
  }

  void
  LinearPrediction::predict(std::vector<double> &next)
  {
    next = history[0];
    if (!find_coefficients())
      return; // at rest, or the first
    std::fill(next.begin(), next.end(), 0.);
    for (unsigned int j = 0; j + 1 < history.size(); ++j)
      Exemplar::add(next, coefficients[j], history[j]);
    if (exchange->sum(dot(next, next)) > max_growth * max_growth * products[0][0])
      next = history[0];
  }
} // namespace Exemplar
