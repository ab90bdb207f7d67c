// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_checks_h
#define exemplar_adjoint_checks_h

#include <exemplar/run/problem/problem.h>

// Preconditions of derivatives_of_slope() and of trajectory_gradients().

namespace Exemplar
{
  /// Whether some cell is orthotropic: nine constants, which Young's modulus and Poisson's ratio do
  /// not give.
  bool
  has_orthotropic_cells(const Problem &problem);

  /// Throws UserError as above, and for scenes that are not static or whose state depends on the
  /// path.
  void
  require_known_scene(const Problem &problem);

  /// Throws UserError where the rotation of a cell is not unique, so that its energy has a kink.
  void
  require_rotations(const Problem &problem);

  /// Throws UserError for a state that is not in equilibrium.
  void
  require_equilibrium(const Problem &problem, const Evaluation &evaluation);

  /// Throws UserError, by name, for scenes that gradients through steps do not know.
  void
  require_known_steps(const Problem &problem);

  /// Throws UserError if the state does not solve the equations of `step`, counted from 0, to the
  /// scene's tolerance, which for quasi-Newton steps is Solver/Step tolerance.
  void
  require_solved_step(const Problem &problem, const Evaluation &evaluation, unsigned int step);
} // namespace Exemplar

#endif
