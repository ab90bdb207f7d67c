// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_conditioning_h
#define exemplar_conditioning_h

#include <deal.II/lac/full_matrix.h>

namespace Exemplar
{
  /// A quadratic form of weights, which come in groups of k one after the other, as one of the
  /// differences of each weight to the first of its group. Only these matter where the sums
  /// of the groups are given.
  dealii::FullMatrix<double>
  form_of_differences(const dealii::FullMatrix<double> &form, unsigned int k);

  /// Ratio of the greatest to the least eigenvalue of a positive semidefinite matrix, whose
  /// rows and columns are first scaled to a diagonal of ones. 1 if it is empty, infinity if it
  /// is not positive definite.
  double
  condition_number(const dealii::FullMatrix<double> &matrix);

  /// How well the systems of a step are conditioned; infinity: not positive definite.
  struct Conditioning
  {
    double matrix = 0.; ///< of A, a lower bound; 0: not known
    double schur  = 0.; ///< of the Schur complement on differences of weights; 0: there is none
  };
} // namespace Exemplar

#endif
