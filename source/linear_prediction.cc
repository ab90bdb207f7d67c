// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/dense_cholesky.h>
#include <exemplar/linear_prediction.h>
#include <exemplar/long_vectors.h>

namespace Exemplar
{
  namespace
  {
    /// Of the trace of the normal equations; so little that it only decides where they are
    /// singular.
    constexpr double ridge = 1e-10;
  } // namespace

  std::vector<double>
  predict_next(const std::deque<std::vector<double>> &history)
  {
    const unsigned int m = history.size() - 1;
    if (m == 0)
      return history[0];
    dealii::FullMatrix<double> gram(m, m);
    std::vector<double>        coefficients(m);
    for (unsigned int i = 0; i < m; ++i)
    {
      coefficients[i] = dot(history[0], history[i + 1]);
      for (unsigned int j = 0; j <= i; ++j)
        gram(i, j) = dot(history[i + 1], history[j + 1]);
    }
    const double trace = gram.trace();
    for (unsigned int i = 0; i < m; ++i)
      gram(i, i) += ridge * trace;
    if (!solve_by_cholesky(gram, coefficients))
      return history[0]; // at rest
    std::vector<double> next(history[0].size(), 0.);
    for (unsigned int j = 0; j < m; ++j)
      add(next, coefficients[j], history[j]);
    return next;
  }
} // namespace Exemplar
