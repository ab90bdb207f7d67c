// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/stretch_modes.h>
#include <exemplar/potential/stretch_stiffness.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// A cell without examples.
    CorotationalCell<double>
    cell_without_target(const CellMaterial<double> &elasticity,
                        const Matrix3<double>      &R,
                        const Matrix3<double>      &F,
                        const PatchDilatation      *dilatation,
                        const unsigned int          cell)
    {
      const bool               has_patches = dilatation != nullptr;
      CorotationalCell<double> state(has_patches ? elasticity.without_dilatation() : elasticity, R,
                                     F, default_guard_bound);
      state.set_target(Matrix3<double>{});
      if (has_patches)
      {
        state.set_guard_material(elasticity);
        state.add_pressure(dilatation->elastic_pressure(cell));
      }
      return state;
    }
  } // namespace

  void
  add_stretch_stiffness(const FESpace         &fe_space,
                        const Material        &material,
                        const CellField       &cells,
                        const CellScatter     &scatter,
                        const PatchDilatation *dilatation,
                        const Vector          &positions,
                        std::vector<double>   &values)
  {
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const CellMaterial<double> &elasticity = material.elasticity(cell);
      const Matrix3<double>       F          = fe_space.deformation_gradient(cell, positions);
      if (!is_strongly_stretched(elasticity, F))
        continue;
      const Matrix3<double> R = closest_rotation(F);
      const StretchModes    modes
          = stretch_modes(cell_without_target(elasticity, R, F, dilatation, cell), R, F);
      const auto &nodes                       = fe_space.nodes(cell);
      double      blocks[3 * n_block_columns] = {};
      for (int m = 0; m < 9; ++m)
      {
        const Matrix3<double> RD = R * modes.direction[m];
        Vector3<double>       g[4]; // in the order of the loops
        for (unsigned int a = 0; a < 4; ++a)
        {
          const auto node = std::find(nodes.begin(), nodes.end(), cells.node(cell, a));
          g[a]            = RD * fe_space.tetrahedron(cell).shape_gradient[node - nodes.begin()];
        }
        const double factor = fe_space.tetrahedron(cell).volume * modes.stiffness[m];
        double      *entry  = blocks;
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b <= a; ++b)
            for (int j = 0; j < 3; ++j)
              for (int i = 0; i < 3; ++i)
                *entry++ += factor * g[a][i] * g[b][j];
      }
      scatter.add_blocks(cells, cell, blocks, values);
    }
  }
} // namespace Exemplar
