// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Exemplar
{
  namespace
  {
    /// L of A = L L^T into A's lower triangle, until a pivot is not accepted(row, pivot, the
    /// diagonal entry of A); returns whether all are.
    template <typename Accepted>
    bool
    factorize_by_cholesky(dealii::FullMatrix<double> &A, const Accepted &accepted)
    {
      for (unsigned int i = 0; i < A.m(); ++i)
        for (unsigned int j = 0; j <= i; ++j)
        {
          const double before = A(i, j);
          double       value  = before;
          for (unsigned int m = 0; m < j; ++m)
            value -= A(i, m) * A(j, m);
          if (i != j)
            A(i, j) = value / A(j, j);
          else if (accepted(i, value, before))
            A(i, i) = std::sqrt(value);
          else
            return false;
        }
      return true;
    }

    using Place = std::pair<unsigned int, unsigned int>;

    /// Of the entry with the greatest absolute value in the rows from `first` on.
    Place
    place_of_greatest(const dealii::FullMatrix<double> &matrix, const unsigned int first)
    {
      Place greatest(first, 0);
      for (unsigned int i = first; i < matrix.m(); ++i)
        for (unsigned int j = 0; j < matrix.n(); ++j)
          if (std::abs(matrix(i, j)) > std::abs(matrix(greatest.first, greatest.second)))
            greatest = { i, j };
      return greatest;
    }
  } // namespace

  bool
  solve_by_cholesky(dealii::FullMatrix<double> &A, std::vector<double> &b)
  {
    const bool is_definite
        = factorize_by_cholesky(A, [](unsigned int, const double pivot, const double diagonal)
                                { return pivot > 1e-14 * std::abs(diagonal) && pivot > 0.; });
    if (!is_definite)
      return false;
    const unsigned int n = b.size();
    for (unsigned int i = 0; i < n; ++i)
    {
      for (unsigned int m = 0; m < i; ++m)
        b[i] -= A(i, m) * b[m];
      b[i] /= A(i, i);
    }
    for (unsigned int i = n; i-- > 0;)
    {
      for (unsigned int m = i + 1; m < n; ++m)
        b[i] -= A(m, i) * b[m];
      b[i] /= A(i, i);
    }
    return true;
  }

  LeastPivot
  least_pivot(dealii::FullMatrix<double> matrix, const double rounding)
  {
    LeastPivot least;
    factorize_by_cholesky(matrix,
                          [&](const unsigned int row, const double pivot, const double diagonal)
                          {
                            const double ratio    = pivot > rounding ? pivot / diagonal : 0.;
                            const bool   is_small = ratio < 1e-14;
                            if (is_small || ratio < least.ratio)
                              least = { row, is_small ? 0. : ratio };
                            return !is_small;
                          });
    return least;
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
