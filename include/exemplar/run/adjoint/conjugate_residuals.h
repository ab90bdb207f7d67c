// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_conjugate_residuals_h
#define exemplar_conjugate_residuals_h

#include <exemplar/run/adjoint/slope_derivatives.h>

#include <vector>

namespace Exemplar
{
  /// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983): minimises the residual
  /// over the preconditioned steps; one step if the preconditioner is the exact inverse.
  class ConjugateResiduals
  {
  public:
    /// `of_weights`: factor of a weight's entry relative to a degree of freedom's in the inner
    /// product.
    explicit ConjugateResiduals(double of_weights) : of_weights(of_weights) {}

    /// Orthonormalise `image`, the image of `step`, against the earlier ones, and subtract from
    /// `rest` its projection on it; add the same multiple of the step to `solution`.
    void
    add(Direction step, Direction image, Direction &solution, Direction &rest);

  private:
    double
    product(const Direction &a, const Direction &b) const;

    const double           of_weights;
    std::vector<Direction> steps, images; ///< images are orthonormal
  };
} // namespace Exemplar

#endif
