// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Exemplar
{
  namespace
  {
    using Place = std::pair<unsigned int, unsigned int>;

    /// Row and column of the entry of greatest absolute value in rows `first` and following.
    Place
    place_of_greatest(const dealii::FullMatrix<double> &matrix, const unsigned int first)
    {
      Place maximum(first, 0);
      for (unsigned int i = first; i < matrix.m(); ++i)
        for (unsigned int j = 0; j < matrix.n(); ++j)
          if (std::abs(matrix(i, j)) > std::abs(matrix(maximum.first, maximum.second)))
            maximum = { i, j };
      return maximum;
    }
  } // namespace

  void
  solve_with_factor(const dealii::FullMatrix<double> &L, std::vector<double> &b)
  {
    const unsigned int n = b.size();
    const auto divide = [&](const unsigned int i) { b[i] = L(i, i) == 0. ? 0. : b[i] / L(i, i); };
    for (unsigned int i = 0; i < n; ++i)
    {
      for (unsigned int m = 0; m < i; ++m)
        b[i] -= L(i, m) * b[m];
      divide(i);
    }
    for (unsigned int i = n; i-- > 0;)
    {
      for (unsigned int m = i + 1; m < n; ++m)
        b[i] -= L(m, i) * b[m];
      divide(i);
    }
  }

  bool
  solve_by_cholesky(dealii::FullMatrix<double> &A, std::vector<double> &b)
  {
    const bool is_definite = factorize_by_cholesky(
        A, [](unsigned int, const double pivot, const double diagonal)
        { return pivot > 1e-14 * std::abs(diagonal) && pivot > 0. ? pivot : -1.; });
    if (is_definite)
      solve_with_factor(A, b);
    return is_definite;
  }

  MinPivot
  min_pivot(dealii::FullMatrix<double> matrix, const double rounding)
  {
    MinPivot minimum;
    factorize_by_cholesky(matrix,
                          [&](const unsigned int row, const double pivot, const double diagonal)
                          {
                            const double ratio    = pivot > rounding ? pivot / diagonal : 0.;
                            const bool   is_small = ratio < 1e-14;
                            if (is_small || ratio < minimum.ratio)
                              minimum = { row, is_small ? 0. : ratio };
                            return is_small ? -1. : pivot;
                          });
    return minimum;
  }

  unsigned int
  rank(dealii::FullMatrix<double> matrix, const double tolerance)
  {
    unsigned int n = 0; // rows done
    for (; n < std::min(matrix.m(), matrix.n()); ++n)
    {
      const auto [row, column] = place_of_greatest(matrix, n);
      if (std::abs(matrix(row, column)) < tolerance)
        break;
      for (unsigned int j = 0; j < matrix.n(); ++j)
        std::swap(matrix(n, j), matrix(row, j));
      for (unsigned int i = n + 1; i < matrix.m(); ++i)
      {
        const double factor = matrix(i, column) / matrix(n, column);
        matrix.add_row(i, -factor, n);
        matrix(i, column) = 0.;
      }
    }
    return n;
  }
} // namespace Exemplar
