// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_qp_h
#define exemplar_weight_qp_h

#include <exemplar/algebra/bordered_system.h>
#include <exemplar/algebra/weight_limits.h>

#include <deal.II/lac/full_matrix.h>

#include <vector>

namespace Exemplar
{
  /// The minimiser of a small convex quadratic over example weights.
  struct WeightQpSolution
  {
    bool                found = false; ///< false: H is not positive definite where it must be
    std::vector<double> weights;
    std::vector<double> multipliers; ///< l_g with (H w - c)_i + l_g = 0 on weights off their bounds
  };

  /// Minimise 1/2 w^T H w - c^T w plus the kinks of `limits` by a primal active set method (Nocedal
  /// and Wright, Algorithm 16.3), in which a weight may also be stuck at its kink: exactly there,
  /// with a derivative of the quadratic less its multiplier between -yield and yield. Off its kink
  /// the derivative includes +-yield. Weights are groups of equal size, one after the other, each
  /// with its sum in `sums`. H need be positive definite only on differences within groups.
  /// Requires that the bounds admit the sums, and that the kinks have these sums, up to rounding. A
  /// `start` within the bounds near the minimiser saves operations; its sums need be right only up
  /// to rounding. Without it the iteration begins at the kinks, if any.
  ///
  /// With bounds from above there are no sums, `sums` is empty, and H must be positive definite. Each
  /// weight and what it lacks to its bound are then a group of two.
  WeightQpSolution
  minimize_over_weights(const dealii::FullMatrix<double> &H,
                        const std::vector<double>        &c,
                        const std::vector<double>        &sums,
                        const WeightLimits               &limits,
                        const std::vector<double>        &start = {});

  /// minimize_over_weights() with the Schur complement of a form; with the form's convexity in addition if that is not
  /// positive definite where it must be.
  WeightQpSolution
  minimize_over_weights(const WeightForm                 &form,
                        const dealii::FullMatrix<double> &schur,
                        const std::vector<double>        &c,
                        const std::vector<double>        &sums,
                        const WeightLimits               &limits,
                        const std::vector<double>        &start = {});
} // namespace Exemplar

#endif
