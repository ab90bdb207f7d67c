// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_dense_h
#define exemplar_dense_h

#include <deal.II/lac/full_matrix.h>

#include <cmath>
#include <vector>

// Dense matrices so small that LAPACK would not pay.

namespace Exemplar
{
  /// Overwrite A's lower triangle, all that it sees, by its Cholesky factor L, A = L L^T.
  /// take_pivot(row, pivot, the diagonal entry of A) returns what to take for a pivot: it, or another
  /// one; zero where the row is to count as one that depends on those before, of which the column
  /// of L is zero then; or a negative number to end. Returns whether it came to the end.
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

  /// Overwrite b by the solution of L L^T x = b, which is zero at the rows that depend on others.
  void
  solve_with_factor(const dealii::FullMatrix<double> &L, std::vector<double> &b);

  /// Solve A x = b in place by Cholesky, seeing only A's lower triangle; false if A is not
  /// positive definite.
  bool
  solve_by_cholesky(dealii::FullMatrix<double> &A, std::vector<double> &b);

  /// The row at which Cholesky's factorisation finds the least pivot relative to its
  /// diagonal entry: that depends most on the rows before it.
  struct MinPivot
  {
    unsigned int row   = 0;
    double       ratio = 1.; ///< 0 if the matrix is singular
  };

  /// Of a positive semidefinite matrix; pivots of at most `rounding` count as zero.
  MinPivot
  min_pivot(dealii::FullMatrix<double> matrix, double rounding);

  /// Number of independent rows (and columns), by Gauss elimination with complete pivoting
  /// that ends at a pivot below `tolerance`.
  unsigned int
  rank(dealii::FullMatrix<double> matrix, double tolerance);
} // namespace Exemplar

#endif
