// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/stretch_modes.h>
#include <exemplar/potential/stretch_stiffness.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    CorotationalCell<double>
    without_target(const CellMaterial<double> &elasticity,
                   const Matrix3<double>      &R,
                   const Matrix3<double>      &F)
    {
      CorotationalCell<double> state(elasticity, R, F, ExampleConstants());
      state.set_target(Matrix3<double>{});
      return state;
    }

    /// Sum over the modes of stiffness V (D : R^T dF)^2 / 2, by the blocks of CellScatter, where
    /// `g` are the gradients of the nodes in the order of the loops.
    void
    add_modes(const StretchModes                 &modes,
              const Matrix3<double>              &R,
              const double                        volume,
              const std::vector<Vector3<double>> &g,
              std::vector<double>                &blocks)
    {
      std::vector<Vector3<double>> turned(g.size());
      for (int m = 0; m < 9; ++m)
      {
        const Matrix3<double> RD = R * modes.direction[m];
        for (std::size_t a = 0; a < g.size(); ++a)
          turned[a] = RD * g[a];
        const double factor = volume * modes.stiffness[m];
        double      *entry  = blocks.data();
        for (std::size_t a = 0; a < g.size(); ++a)
          for (std::size_t b = 0; b <= a; ++b)
            for (int j = 0; j < 3; ++j)
              for (int i = 0; i < 3; ++i)
                *entry++ += factor * turned[a][i] * turned[b][j];
      }
    }
  } // namespace

  void
  add_stretch_stiffness(const FESpace       &fe_space,
                        const Material      &material,
                        const CellField     &cells,
                        const CellScatter   &scatter,
                        const Vector        &positions,
                        std::vector<double> &values)
  {
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      if (!traits_of(cells.get_batches().law(point)).has_stretch_guard)
        continue;
      const unsigned int          cell       = fe_space.cell_of(point);
      const CellMaterial<double> &elasticity = material.elasticity(cell);
      const Matrix3<double>       F          = fe_space.deformation_gradient(point, positions);
      const KinkSlope<double>     kink       = kink_slope(elasticity, sqrt(contract(F, F)));
      if (!is_strongly_stretched(kink))
        continue;
      const Matrix3<double>        R     = closest_rotation(F);
      const auto                   nodes = fe_space.nodes(cell);
      std::vector<Vector3<double>> g;
      for (unsigned int a = 0; a < nodes.size(); ++a)
      {
        const auto node = std::find(nodes.begin(), nodes.end(), cells.node(point, a));
        g.push_back(fe_space.gradients(point)[node - nodes.begin()]);
      }
      std::vector<double> blocks(3 * n_block_columns(nodes.size()), 0.);
      add_modes(stretch_modes(without_target(elasticity, R, F), R, F), R, fe_space.volume(point), g,
                blocks);
      scatter.add_blocks(cell, blocks.data(), values);
    }
  }
} // namespace Exemplar
