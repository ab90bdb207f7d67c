// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_dilatation_h
#define exemplar_loops_dilatation_h

#include <exemplar/kernels/loops_energy.h>

// The loops of mean dilatation by patches, Eq. (25): what cells tell their patch, and the forces of
// its pressure.

namespace Exemplar::Loops
{
  template <typename Number, int n_nodes>
  inline void
  dilatations(const CellTask &task, const std::size_t begin, const std::size_t end)
  {
    with_cell_model<Number>(
        task.cells.law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          if constexpr (Cell::traits.trace_gradient_is_R)
            for_each_group_of_law<Number>(
                task.cells, begin, end,
                [&](const LaneGroup<Number> &group)
                {
                  const Matrix3<Number> F = deformation_gradient(
                      task, group, load_tetrahedron<n_nodes>(task.cells, group));
                  store_dilatation(task, group,
                                   Cell::strain_of(load_rotation(task.cells, group), F), F);
                });
        });
  }

  /// The derivative of tr(e) by F is R for every strain that has patches, so that a pressure p
  /// makes the forces V p R g_a.
  template <typename Number, int n_nodes>
  inline void
  add_pressure_forces(const CellTask   &task,
                      const std::size_t begin,
                      const std::size_t end,
                      double           *nodal_sums)
  {
    for_each_group<Number>(
        begin, end,
        [&](const LaneGroup<Number> &group)
        {
          const auto      tet = load_tetrahedron<n_nodes>(task.cells, group);
          const Number    Vp  = tet.volume * load(task.dilatation.pressures, group, 1, 0);
          Matrix3<Number> R   = load_rotation(task.cells, group);
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              R[i][j] *= Vp;
          add_forces(task, group, tet, R, tet.volume * load(task.dilatation.scales, group, 1, 0),
                     nodal_sums);
        });
  }
} // namespace Exemplar::Loops

#endif
