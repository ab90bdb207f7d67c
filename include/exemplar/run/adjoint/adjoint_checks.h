// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_checks_h
#define exemplar_adjoint_checks_h

#include <exemplar/run/problem/problem.h>

// What derivatives_of_slope() relies on.

namespace Exemplar
{
  /// Whether some have nine constants, which do not follow from Young's modulus and Poisson's ratio.
  bool
  has_orthotropic_cells(const Problem &problem);

  /// Throws UserError, by name, for what the potential has and derivatives_of_slope() does not know.
  void
  require_known_potential(const Problem &problem);

  /// The same for a static scene whose equilibrium has been found.
  void
  require_known_scene(const Problem &problem);

  /// Throws UserError where the rotation of a cell is not unique, so that its energy has a kink.
  void
  require_rotations(const Problem &problem);

  /// Throws UserError for a state that is not in equilibrium.
  void
  require_equilibrium(const Problem &problem, const Evaluation &evaluation);
} // namespace Exemplar

#endif
