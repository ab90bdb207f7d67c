// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_dense_h
#define exemplar_dense_h

#include <deal.II/lac/full_matrix.h>

#include <vector>

// Dense matrices so small that LAPACK would not pay.

namespace Exemplar
{
  /// Solve A x = b in place by Cholesky, seeing only A's lower triangle; false if A is not
  /// positive definite.
  bool
  solve_by_cholesky(dealii::FullMatrix<double> &A, std::vector<double> &b);

  /// The row at which Cholesky's factorisation finds the least pivot relative to its
  /// diagonal entry: that depends most on the rows before it.
  struct LeastPivot
  {
    unsigned int row   = 0;
    double       ratio = 1.; ///< 0 if the matrix is singular
  };

  /// Of a positive semidefinite matrix; pivots of at most `rounding` count as zero.
  LeastPivot
  least_pivot(dealii::FullMatrix<double> matrix, double rounding);

  /// Number of independent rows (and columns), by Gauss elimination with complete pivoting
  /// that ends at a pivot below `tolerance`.
  unsigned int
  rank(dealii::FullMatrix<double> matrix, double tolerance);
} // namespace Exemplar

#endif
