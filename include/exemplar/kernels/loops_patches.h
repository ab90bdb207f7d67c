// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_patches_h
#define exemplar_loops_patches_h

#include <exemplar/kernels/loops_blocks.h>
#include <exemplar/kernels/loops_dilatation.h>

// The tangent of patches, Eqs. (25) and (26): lambda_p V_p b b^T, and further terms in thin cells
// and in strongly stretched patches.

namespace Exemplar::Loops
{
  template <typename Number, int n_nodes>
  inline void
  patch_gradients(const CellArrays  &cells,
                  const PatchArrays &patches,
                  const std::size_t  begin,
                  const std::size_t  end)
  {
    constexpr std::size_t n_gradients = 3 * (n_nodes - 1);
    std::fill(patches.gradients + 4 * patches.node_starts[begin],
              patches.gradients + 4 * patches.node_starts[end], 0.);
    for (std::size_t k = patches.point_starts[begin]; k < patches.point_starts[end]; ++k)
    {
      const unsigned int point = patches.points[k];
      const double      *r = cells.rotations + batch_index(point, 9, 0), f = patches.fractions[k];
      const double      *g     = cells.gradients + batch_index(point, n_gradients, 0);
      const int         *place = patches.places + n_nodes * k;
      Four               R[3]; // columns of R
      for (std::size_t j = 0; j < 3; ++j)
        R[j] = Four{ f * r[j * batch_size], f * r[(3 + j) * batch_size],
                     f * r[(6 + j) * batch_size], 0. };
      Four first = {}; // shape functions sum to one
      for (int a = 1; a < n_nodes; ++a, g += 3 * batch_size)
      {
        const Four of_node = R[0] * g[0] + R[1] * g[batch_size] + R[2] * g[2 * batch_size];
        add_four(of_node, patches.gradients + 4 * place[a]);
        first -= of_node;
      }
      add_four(first, patches.gradients + 4 * place[0]);
    }
  }

  /// Add u[j] v to column j at the rows of each node from `offsets` on; for the first node, which
  /// is the column's own, the lower triangle only.
  [[gnu::always_inline]] static inline void
  add_products(const double     *u,
               const double     *v,
               const std::size_t n_rows,
               const int        *offsets,
               double *const (&columns)[3],
               const int n_columns)
  {
    const Four rows[3] = { { 1., 1., 1., 0. }, { 0., 1., 1., 0. }, { 0., 0., 1., 0. } };
    Four       own;
    load_four(v, own);
    for (int j = 0; j < n_columns; ++j)
      add_four(own * rows[j] * u[j], columns[j]);
    if (n_columns == 3) // nearly always; the inner loop of the assembly
      for (std::size_t row = 1; row < n_rows; ++row)
      {
        if (offsets[row] < 0)
          continue;
        Four of_row;
        load_four(v + 4 * row, of_row);
        for (int j = 0; j < 3; ++j)
          add_four(of_row * u[j], columns[j] + offsets[row]);
      }
    else
      for (std::size_t row = 1; row < n_rows; ++row)
      {
        if (offsets[row] < 0)
          continue;
        Four of_row;
        load_four(v + 4 * row, of_row);
        for (int j = 0; j < n_columns; ++j)
          add_four(of_row * u[j], columns[j] + offsets[row]);
      }
  }

  template <typename Number>
  inline void
  add_patch_products(const PatchColumns &to,
                     const std::size_t   begin,
                     const std::size_t   end,
                     double             *values)
  {
    for (std::size_t node = begin; node < end; ++node)
    {
      double *columns[3];
      int     n_columns = 0;
      for (; n_columns < 3 && to.columns[3 * node + n_columns] >= 0; ++n_columns)
        columns[n_columns] = values + to.columns[3 * node + n_columns] - n_columns;
      for (std::size_t k = to.starts[node]; k < to.starts[node + 1]; ++k)
      {
        const PatchAtNode &at      = to.patches[k];
        const std::size_t  n_rows  = to.node_starts[at.patch + 1] - at.place;
        const int         *offsets = to.offsets + at.offsets;
        const auto         add     = [&](const double a, const double *u, const double *v)
        {
          u += 4 * at.place;
          const double a_u[3] = { a * u[0], a * u[1], a * u[2] };
          add_products(a_u, v + 4 * at.place, n_rows, offsets, columns, n_columns);
        };
        add(to.factors[at.patch], to.vectors, to.vectors);
        if (to.squares == nullptr)
          continue;
        if (const double a = to.of_squares[at.patch]; a != 0.)
          add(a, to.squares, to.squares);
        if (const double a = to.of_products[at.patch]; a != 0.)
        {
          add(a, to.squares, to.sums);
          add(a, to.sums, to.squares);
        }
      }
    }
  }

  template <typename Number, int n_nodes>
  inline void
  add_patch_tangent(const CellTask    &task,
                    const TangentTask &tangent,
                    const std::size_t  begin,
                    const std::size_t  end)
  {
    if (!law_functions<Number>(task.cells.law).traits->has_guard_of_patches())
      return;
    alignas(64) BlockColumns<Number, n_nodes> columns = {};
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          if (!is_special(task.dilatation, group))
            return;
          const auto            tet = load_tetrahedron<n_nodes>(task.cells, group);
          const Matrix3<Number> R   = load_rotation(task.cells, group);
          const auto   cell = patch_cell(task, group, R, deformation_gradient(task, group, tet));
          const Number pressure = load(task.dilatation.pressures, group, 1, 0);
          LawTangent<Number> of_point;
          of_point.set([&](const Matrix3<Number> &M)
                       { return cell.response(M, pressure, tangent.convex); });
          cell_blocks(of_point, R, tet, columns);
          add_blocks<Number, n_nodes>(task, tangent, begin, group, columns);
        });
  }
} // namespace Exemplar::Loops

#endif
