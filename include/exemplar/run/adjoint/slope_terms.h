// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_terms_h
#define exemplar_slope_terms_h

#include <exemplar/run/adjoint/slope_derivatives.h>

// The slope of what is not elastic, and what all terms need.

namespace Exemplar
{
  /// Add the derivatives by the nodes of a cell of what has the derivative `by_F` by sum x_a g_a^T.
  void
  add_forces(const FESpace &fe_space, unsigned int point, const Matrix3<double> &by_F, Vector &to);

  /// The same by the vertices of a cell, for sum X_v grad L_v^T with the linear functions L_v that are 1 at one
  /// vertex: what moves the other nodes with them.
  void
  add_at_vertices(const FESpace         &fe_space,
                  unsigned int           cell,
                  const Matrix3<double> &by_gradient,
                  Vector                &to);

  /// The same of what depends on the rest positions by the volume of a cell alone; the derivative is given
  /// times the volume.
  void
  add_volume(const FESpace &fe_space, unsigned int cell, double by_volume, Vector &to);

  /// Of the ridge sigma/2 sum w_i^2 on weights that are to be found, and of what moving them costs, Eq. (27).
  void
  add_slope_of_ridge(const Problem &problem, const Direction &direction, SlopeDerivatives &sums);

  /// Of gravity and nodal forces.
  void
  add_slope_of_loads(const Problem &problem, const Direction &direction, SlopeDerivatives &sums);
} // namespace Exemplar

#endif
