// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_qp_h
#define exemplar_weight_qp_h

#include <deal.II/lac/full_matrix.h>

#include <vector>

namespace Exemplar
{
  /// The minimiser of a small convex quadratic over example weights.
  struct WeightQpSolution
  {
    bool                found = false; ///< false: H is not positive definite where it must be
    std::vector<double> weights;
    double              multiplier = 0.; ///< l with H w - c + l = 0 on the weights off their bounds
  };

  /// Minimise 1/2 w^T H w - c^T w over sum w = `sum` and, unless `lower` is empty,
  /// w_i >= lower_i, by a primal active set method (Nocedal and Wright, Algorithm 16.3).
  /// H need be positive definite only on differences of weights. Requires sum lower <= sum.
  WeightQpSolution
  minimize_over_weights(const dealii::FullMatrix<double> &H,
                        const std::vector<double>        &c,
                        double                            sum,
                        const std::vector<double>        &lower);
} // namespace Exemplar

#endif
