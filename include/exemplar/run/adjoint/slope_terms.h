// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_terms_h
#define exemplar_slope_terms_h

#include <exemplar/run/adjoint/slope_derivatives.h>

// The slope of terms that are not elastic, and helpers for all terms.

namespace Exemplar
{
  /// Add a function's derivatives by the nodes' positions x_a, given its derivative `by_F` by F =
  /// sum x_a g_a^T.
  void
  add_forces(const FESpace &fe_space, unsigned int point, const Matrix3<double> &by_F, Vector &to);

  /// Add a function's derivatives by the vertices' rest positions X_v, given `by_gradient` by sum
  /// X_v grad L_v^T with the barycentric coordinates L_v of a cell; its other nodes move with the
  /// vertices.
  void
  add_at_vertices(const FESpace         &fe_space,
                  unsigned int           cell,
                  const Matrix3<double> &by_gradient,
                  Vector                &to);

  /// Slope of the ridge sigma/2 sum w_i^2 on unknown weights and of the cost of moving them, Eq.
  /// (27).
  void
  add_slope_of_ridge(const Problem &problem, const Direction &direction, SlopeDerivatives &sums);

  /// Slope of gravity and nodal forces.
  void
  add_slope_of_loads(const Problem &problem, const Direction &direction, SlopeDerivatives &sums);

  /// Slope of the tension of fibres, whose directions and tensions belong to cells wherever these are.
  void
  add_slope_of_tension(const Problem &problem, const Direction &direction, SlopeDerivatives &sums);
} // namespace Exemplar

#endif
