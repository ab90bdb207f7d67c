// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_of_shell_h
#define exemplar_slope_of_shell_h

#include <exemplar/run/adjoint/slope_of_motion.h>

// The slope of the energy of a shell, Eq. (47), for problems of one.

namespace Exemplar
{
  /// Adds the derivatives of the elastic slope at the problem's state. Those by positions have the stiffness damping of the step
  /// already, as the tangent has it.
  void
  add_slope_of_shell(Problem &problem, const Direction &direction, SlopeDerivatives &sums);

  /// Adds all other derivatives of the slope of stiffness damping in a step from `start`.
  void
  add_slope_of_shell_damping(Problem           &problem,
                             const State       &start,
                             const Direction   &direction,
                             SlopeDerivatives  &sums,
                             MotionDerivatives &of_motion);

  /// Chain rule: from the strains of examples to poses, with the tips of all normals, and to thicknesses.
  void
  carry_to_shell(const Problem &problem, SlopeDerivatives &sums);
} // namespace Exemplar

#endif
