// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_of_motion_h
#define exemplar_slope_of_motion_h

#include <exemplar/run/adjoint/slope_derivatives.h>

// The slope of inertia and damping, Eq. (22), in a step that potential.begin_step() has begun; the
// problem's state is the end of the step.

namespace Exemplar
{
  /// Derivatives of the slope of a step by the data of dynamic scenes alone, at fixed a and b.
  struct MotionDerivatives
  {
    Vector by_base;            ///< derivative by x_star of the inertia
    Vector by_base_velocities; ///< derivative by v_star
    /// Derivatives by the earlier positions of TimeIntegrator::history() in the strains of damping;
    /// empty without it.
    std::vector<Vector> by_past;
    double              by_mass_damping = 0., by_stiffness_damping = 0.;
  };

  /// Adds the slope a.M q of inertia, q = gamma (gamma + a_M) (x - x_hat).
  void
  add_slope_of_inertia(const Problem     &problem,
                       const Direction   &direction,
                       SlopeDerivatives  &sums,
                       MotionDerivatives &of_motion);

  /// Adds the slope of stiffness damping in a step from `start`.
  void
  add_slope_of_damping(Problem              &problem,
                       const ExampleStrains &of_examples,
                       const State          &start,
                       const Direction      &direction,
                       SlopeDerivatives     &sums,
                       MotionDerivatives    &of_motion);
} // namespace Exemplar

#endif
