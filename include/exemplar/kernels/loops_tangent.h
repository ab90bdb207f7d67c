// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_tangent_h
#define exemplar_loops_tangent_h

#include <exemplar/kernels/loops_examples.h>
#include <exemplar/kernels/loops_stiffness.h>

// The tangents of laws that are not R K R^T, Eqs. (18) and (19), and the update of history
// variables.

namespace Exemplar::Loops
{
  /// The cell of each lane with its material, deformation and target strain, damping and the
  /// patch's pressure included.
  template <typename Cell, typename Number, int n_nodes>
  inline Cell
  driven_cell(const CellTask                     &task,
              const TangentTask                  &tangent,
              const LaneGroup<Number>            &group,
              const Tetrahedron<Number, n_nodes> &tet,
              const Matrix3<Number>              &R)
  {
    Cell cell = make_cell<Cell>(task.cells, group, R, deformation_gradient(task, group, tet));
    Matrix3<Number> D = target(task, group);
    if (task.damping.factors != nullptr)
    {
      D = cell.damp(D, load(task.damping.factors, group, 1, 0),
                    load_strain(task.damping.strains, group, 1, 0));
    }
    cell.set_target(D);
    if constexpr (Cell::traits.trace_gradient_is_R)
      if (task.dilatation.pressures != nullptr)
        cell.add_pressure(load(task.dilatation.pressures, group, 1, 0));
    add_volume_pressure(task, group, cell);
    if constexpr (!Cell::traits.convex_is_rotated)
      if (tangent.convex)
        cell.make_convex();
    return cell;
  }

  template <typename Laws, typename Number, int n_nodes>
  inline void
  add_tangent(const CellTask    &task,
              const TangentTask &tangent,
              const std::size_t  begin,
              const std::size_t  end)
  {
    alignas(64) BlockColumns<Number, n_nodes> columns = {};
    with_cell_model<Number>(
        Laws(), task.cells.law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          if constexpr (!Cell::traits.exact_is_rotated)
            for_each_group_of_law<Number>(
                task.cells, begin, end,
                [&](const LaneGroup<Number> &group)
                {
                  const auto tet = load_tetrahedron<n_nodes>(task.cells, group);
                  const auto R   = load_rotation(task.cells, group);
                  cell_blocks(driven_cell<Cell>(task, tangent, group, tet, R), R, tet, columns);
                  add_blocks<Number, n_nodes>(task, tangent, begin, group, columns);
                });
        });
  }

  template <typename Laws, typename Number, int n_nodes>
  inline void
  advance_history(const CellTask &task, const std::size_t begin, const std::size_t end)
  {
    with_cell_model<Number>(
        Laws(), task.cells.law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          if constexpr (constexpr std::size_t n = Cell::traits.n_history; n > 0)
            for_each_group_of_law<Number>(
                task.cells, begin, end,
                [&](const LaneGroup<Number> &group)
                {
                  const Cell cell = make_cell<Cell>(
                      task.cells, group, load_rotation(task.cells, group),
                      deformation_gradient(task, group,
                                           load_tetrahedron<n_nodes>(task.cells, group)));
                  for (std::size_t k = 0; k < n; ++k)
                    store(task.cells, group, cell.new_history(k), task.cells.history, n, k);
                });
        });
  }
} // namespace Exemplar::Loops

#endif
