// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_of_motion_h
#define exemplar_slope_of_motion_h

#include <exemplar/run/adjoint/slope_derivatives.h>

// The slope of inertia and damping, Eq. (22), in a step that potential.begin_step() has begun and at whose
// end the problem stands.

namespace Exemplar
{
  /// Of the slope of a step the derivatives by what only moving bodies have, at fixed a and b.
  struct MotionDerivatives
  {
    Vector by_base;            ///< x_star of the inertia, by degree of freedom
    Vector by_base_velocities; ///< v_star
    /// The earlier positions of TimeIntegrator::history() whose strains damping compares; empty without it.
    std::vector<Vector> by_past;
    double              by_mass_damping = 0., by_stiffness_damping = 0.;
  };

  /// With q = gamma (gamma + a_M) (x - x_hat) the slope of inertia is a.M q.
  void
  add_slope_of_inertia(const Problem     &problem,
                       const Direction   &direction,
                       SlopeDerivatives  &sums,
                       MotionDerivatives &of_motion);

  /// Of stiffness damping, in a step from `start`.
  void
  add_slope_of_damping(const Problem        &problem,
                       const ExampleStrains &of_examples,
                       const State          &start,
                       const Direction      &direction,
                       SlopeDerivatives     &sums,
                       MotionDerivatives    &of_motion);
} // namespace Exemplar

#endif
