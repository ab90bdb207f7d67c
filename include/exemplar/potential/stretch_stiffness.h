// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_stretch_stiffness_h
#define exemplar_stretch_stiffness_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/potential/cell_scatter.h>

#include <vector>

namespace Exemplar
{
  /// Add to the values of the convex tangent R K R^T what it lacks in strongly stretched cells, see
  /// stretch_modes.h. `positions` are by degree of freedom [m], `material` that of the cells' own
  /// energy.
  void
  add_stretch_stiffness(const FESpace       &fe_space,
                        const Material      &material,
                        const CellField     &cells,
                        const CellScatter   &scatter,
                        const Vector        &positions,
                        std::vector<double> &values);
} // namespace Exemplar

#endif
