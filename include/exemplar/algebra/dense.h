// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_dense_h
#define exemplar_dense_h

#include <deal.II/lac/full_matrix.h>

#include <cmath>
#include <vector>

// Dense matrices so small that LAPACK would not pay.

namespace Exemplar
{
  /// Overwrite A's lower triangle, the only part read, by its Cholesky factor L, A = L L^T.
  /// take_pivot(row, pivot, the diagonal entry of A) returns the pivot to use: the given or another
  /// one; zero for a row to count as linearly dependent, whose column of L becomes zero; or a
  /// negative number to stop. Returns whether the factorisation was completed.
  template <typename TakePivot>
  bool
  factorize_by_cholesky(dealii::FullMatrix<double> &A, const TakePivot &take_pivot)
  {
    for (unsigned int i = 0; i < A.m(); ++i)
      for (unsigned int j = 0; j <= i; ++j)
      {
        const double before = A(i, j);
        double       value  = before;
        for (unsigned int m = 0; m < j; ++m)
          value -= A(i, m) * A(j, m);
        if (i != j)
          A(i, j) = A(j, j) == 0. ? 0. : value / A(j, j);
        else
        {
          const double pivot = take_pivot(i, value, before);
          if (pivot < 0.)
            return false;
          A(i, i) = std::sqrt(pivot);
        }
      }
    return true;
  }

  /// Overwrite b by the solution of L L^T x = b, with zeros at rows marked as dependent.
  void
  solve_with_factor(const dealii::FullMatrix<double> &L, std::vector<double> &b);

  /// Solve A x = b in place by Cholesky's factorisation of A's lower triangle; false if A is not
  /// positive definite.
  bool
  solve_by_cholesky(dealii::FullMatrix<double> &A, std::vector<double> &b);

  /// The row with the least pivot of Cholesky's factorisation relative to its diagonal entry: the
  /// one nearest to a linear combination of the rows before it.
  struct MinPivot
  {
    unsigned int row   = 0;
    double       ratio = 1.; ///< 0 if the matrix is singular
  };

  /// Least pivot of a positive semidefinite matrix; pivots of at most `rounding` count as zero.
  MinPivot
  min_pivot(dealii::FullMatrix<double> matrix, double rounding);

  /// Rank by Gauss elimination with complete pivoting, which ends at a pivot below `tolerance`.
  unsigned int
  rank(dealii::FullMatrix<double> matrix, double tolerance);
} // namespace Exemplar

#endif
