// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_dense_cholesky_h
#define exemplar_dense_cholesky_h

#include <deal.II/lac/full_matrix.h>

#include <vector>

namespace Exemplar
{
  /// Solve A x = b in place by Cholesky, seeing only A's lower triangle; false if A is not
  /// positive definite. For matrices so small that LAPACK would not pay.
  bool
  solve_by_cholesky(dealii::FullMatrix<double> &A, std::vector<double> &b);
} // namespace Exemplar

#endif
