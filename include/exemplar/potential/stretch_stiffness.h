// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_stretch_stiffness_h
#define exemplar_stretch_stiffness_h

#include <exemplar/body/fe_space.h>
#include <exemplar/kernels/stretch_modes.h>
#include <exemplar/potential/cell_scatter.h>

#include <vector>

namespace Exemplar
{
  /// Whether a point is so far stretched that the convex tangent R K R^T lacks something, see
  /// stretch_modes.h.
  bool
  is_strongly_stretched(const CellField &cells, unsigned int point, const Matrix3<double> &F);

  /// What it lacks there, with the rotation R of F.
  StretchModes
  stretch_modes(const CellField       &cells,
                unsigned int           point,
                const Matrix3<double> &R,
                const Matrix3<double> &F);

  /// Add to the values of the convex tangent R K R^T what it lacks in strongly stretched cells, see
  /// stretch_modes.h. `positions` are by degree of freedom [m].
  void
  add_stretch_stiffness(const FESpace       &fe_space,
                        const CellField     &cells,
                        const CellScatter   &scatter,
                        const Vector        &positions,
                        std::vector<double> &values);
} // namespace Exemplar

#endif
