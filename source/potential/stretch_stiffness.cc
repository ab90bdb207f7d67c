// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/stretch_stiffness.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    bool
    is_in_stretched_patch(const CellField &cells, const unsigned int point)
    {
      const StretchField &patch = cells.get_dilatation().stretch;
      return patch.acts && patch.transitions[point] > 0.;
    }

    CellMaterial<double>
    elasticity_of_guard(const CellField &cells, const unsigned int point)
    {
      if (!is_in_stretched_patch(cells, point))
        return cells.get_batches().constants<CellMaterial<double>>(point);
      const dealii::AlignedVector<double> &numbers = cells.get_dilatation().stretch.elasticity;
      return { numbers[batch_index(point, 2, 0)], numbers[batch_index(point, 2, 1)] };
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

  bool
  is_strongly_stretched(const CellField &cells, const unsigned int point, const Matrix3<double> &F)
  {
    return is_strongly_stretched(
        kink_slope(elasticity_of_guard(cells, point), sqrt(contract(F, F))));
  }

  StretchModes
  stretch_modes(const CellField       &cells,
                const unsigned int     point,
                const Matrix3<double> &R,
                const Matrix3<double> &F)
  {
    CorotationalCell<double> state(cells.get_batches().constants<CellMaterial<double>>(point), R, F,
                                   ExampleConstants());
    state.set_target(Matrix3<double>{});
    state.set_guard_elasticity(elasticity_of_guard(cells, point));
    if (is_in_stretched_patch(cells, point))
      state.add_pressure(cells.get_dilatation().stretch.pressures[point]);
    return stretch_modes(state, R, F);
  }

  void
  add_stretch_stiffness(const FESpace       &fe_space,
                        const CellField     &cells,
                        const CellScatter   &scatter,
                        const Vector        &positions,
                        std::vector<double> &values)
  {
    const StretchField &patch = cells.get_dilatation().stretch;
    if (cells.get_dilatation().is_filled() && !patch.acts)
      return;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      if ((patch.acts && patch.transitions[point] == 0.)
          || !traits_of(cells.get_batches().law(point)).has_stretch_guard)
        continue;
      const unsigned int    cell = fe_space.cell_of(point);
      const Matrix3<double> F    = fe_space.deformation_gradient(point, positions);
      if (!is_strongly_stretched(cells, point, F))
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
      add_modes(stretch_modes(cells, point, R, F), R, fe_space.volume(point), g, blocks);
      scatter.add_blocks(cell, blocks.data(), values);
    }
  }
} // namespace Exemplar
