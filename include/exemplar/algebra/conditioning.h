// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_conditioning_h
#define exemplar_conditioning_h

#include <deal.II/lac/full_matrix.h>

namespace Exemplar
{
  /// The quadratic form restricted to differences: weights come in groups of k consecutive ones,
  /// and each is replaced by its difference to the first of its group. Where group sums are given,
  /// only these differences are free.
  dealii::FullMatrix<double>
  form_of_differences(const dealii::FullMatrix<double> &form, unsigned int k);

  /// Ratio of the greatest to the least eigenvalue of a positive semidefinite matrix after
  /// symmetric scaling to a unit diagonal. 1 if it is empty, infinity if it is not positive
  /// definite.
  double
  condition_number(const dealii::FullMatrix<double> &matrix);

  /// Condition numbers of the linear systems of a step; infinity: not positive definite.
  struct Conditioning
  {
    double matrix = 0.; ///< lower bound of that of A; 0: not known
    double schur  = 0.; ///< that of the Schur complement on differences of weights; 0: none
  };
} // namespace Exemplar

#endif
