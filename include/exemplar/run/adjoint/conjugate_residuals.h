// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_conjugate_residuals_h
#define exemplar_conjugate_residuals_h

#include <exemplar/run/adjoint/slope_derivatives.h>

#include <vector>

namespace Exemplar
{
  /// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983): of the steps that an approximate
  /// inverse proposes, those sums that leave the least of a right side. They end where the inverse is exact at
  /// once, and also where it is only near.
  class ConjugateResiduals
  {
  public:
    /// `of_weights`: what a weight's entry counts beside one of a degree of freedom.
    explicit ConjugateResiduals(double of_weights) : of_weights(of_weights) {}

    /// Take from `rest` what the best multiple of `step`, of which `image` is the image, takes of it, and add
    /// that to `solution`. Earlier steps keep what they have taken.
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
