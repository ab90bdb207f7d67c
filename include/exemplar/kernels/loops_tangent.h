// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_tangent_h
#define exemplar_loops_tangent_h

#include <exemplar/kernels/loops_examples.h>
#include <exemplar/kernels/loops_stiffness.h>

// The tangents of the models that are not R K R^T, Eqs. (18) and (19).

namespace Exemplar::Loops
{
  /// A cell of each lane with its material, positions and target strain, damping included.
  template <typename Cell, typename Number, int n_nodes>
  inline Cell
  driven_cell(const CellTask                     &task,
              const TangentTask                  &tangent,
              const LaneGroup<Number>            &group,
              const Tetrahedron<Number, n_nodes> &tet,
              const Matrix3<Number>              &R)
  {
    Cell            cell(load_constants<typename Cell::Constants>(task.cells, group), R,
                         deformation_gradient(task, group, tet), task.cells.guard_bound);
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
    if constexpr (!Cell::traits.convex_is_rotated)
      if (tangent.convex)
        cell.make_convex();
    return cell;
  }

  /// Three columns of each block, with space for four rows, of the cells of a group.
  template <typename Number, int n_nodes>
  using BlockColumns = double[n_block_columns(n_nodes)][4][LaneGroup<Number>::width];

  /// V R times the responses of a cell to changes e_k (x) g of R^T F, for three k.
  template <typename Cell, typename Number>
  inline void
  node_responses(const Cell            &cell,
                 const Matrix3<Number> &VR,
                 const Vector3<Number> &g,
                 Matrix3<Number> (&response)[3])
  {
    for (int k = 0; k < 3; ++k)
    {
      Matrix3<Number> M{};
      for (int l = 0; l < 3; ++l)
        M[k][l] = g[l];
      response[k] = VR * cell.response(M);
    }
  }

  /// d f_a / d x_b for the cells of a group.
  template <typename Cell, typename Number, int n_nodes>
  inline void
  cell_blocks(const Cell                         &cell,
              const Matrix3<Number>              &R,
              const Tetrahedron<Number, n_nodes> &tet,
              BlockColumns<Number, n_nodes>      &columns)
  {
    Matrix3<Number> VR = R;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        VR[i][j] *= tet.volume;
    // node b moves by the unit vector k of the rotated frame; of these three responses that to a
    // unit vector j of space is a combination
    for (int b = 0; b < n_nodes; ++b)
    {
      Matrix3<Number> response[3];
      node_responses(cell, VR, tet.shape_gradient[b], response);
      for (int a = b; a < n_nodes; ++a)
      {
        Vector3<Number> force[3];
        for (int k = 0; k < 3; ++k)
          force[k] = response[k] * tet.shape_gradient[a];
        const int block = a * (a + 1) / 2 + b;
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i)
            Lanes<Number>::store(a == b && i < j ? Number(0.)
                                                 : force[0][i] * R[j][0] + force[1][i] * R[j][1]
                                                       + force[2][i] * R[j][2],
                                 columns[3 * block + j][i]);
      }
    }
  }

  template <typename Number, int n_nodes>
  inline void
  add_tangent(const CellTask    &task,
              const TangentTask &tangent,
              const std::size_t  begin,
              const std::size_t  end)
  {
    constexpr std::size_t n_points = std::min(LaneGroup<Number>::width, points_of_cell(n_nodes));

    alignas(64) BlockColumns<Number, n_nodes> columns = {};
    const auto                                add     = [&](const LaneGroup<Number> &group)
    {
      for (std::size_t lane = 0; lane < LaneGroup<Number>::width; lane += n_points)
      {
        const std::size_t cell = group.cell(lane);
        if (cell >= task.cells.n_cells)
          return;
        const int *position = matrix_positions<n_nodes>(tangent, begin, cell);
        for (std::size_t column = 0; column < n_block_columns(n_nodes); ++column)
          if (position[column] >= 0)
            for (int i = 0; i < 3; ++i)
            {
              double sum = columns[column][i][lane];
              for (std::size_t p = 1; p < n_points; ++p)
                sum += columns[column][i][lane + p];
              tangent.values[position[column] + i] += sum;
            }
      }
    };
    with_cell_model<Number>(task.cells.law,
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
                                      cell_blocks(driven_cell<Cell>(task, tangent, group, tet, R),
                                                  R, tet, columns);
                                      add(group);
                                    });
                            });
  }
} // namespace Exemplar::Loops

#endif
