// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_stiffness_h
#define exemplar_loops_stiffness_h

#include <exemplar/kernels/loops_io.h>

// The loop that adds R K R^T, Eq. (8). The stiffness of an isotropic material is turned by turning
// the four gradients of a cell.

namespace Exemplar::Loops
{
  /// What makes R K R^T of the cells of a group, Eq. (8), for an isotropic material. Lanes are
  /// stored apart, because each cell is then added by itself.
  template <typename Number>
  struct RotatedStiffness
  {
    alignas(64) double g[4][3][LaneGroup<Number>::width];        ///< R g_a
    alignas(64) double lambda_g[4][3][LaneGroup<Number>::width]; ///< times V lambda
    alignas(64) double mu_g[4][3][LaneGroup<Number>::width];     ///< times V mu
    alignas(64) double diagonal[4][4][LaneGroup<Number>::width]; ///< V mu g_a.g_b, a >= b
  };

  template <typename Number>
  inline void
  find_rotated_stiffness(const CellTask           &task,
                         const LaneGroup<Number>  &group,
                         RotatedStiffness<Number> &K)
  {
    const Tetrahedron<Number> tet    = load_tetrahedron(task.cells, group);
    const Matrix3<Number>     R      = load_rotation(task.cells, group);
    Number                    factor = tet.volume;
    if (task.damping.factors != nullptr)
      factor *= Number(1.) + load(task.damping.factors, group, 1, 0);
    const auto [lambda, mu] = load_material(task.cells.material, group).scaled(factor);
    Vector3<Number> g[4];
    rotate_gradients(tet, R, g);
    for (int a = 0; a < 4; ++a)
    {
      for (int i = 0; i < 3; ++i)
      {
        Lanes<Number>::store(g[a][i], K.g[a][i]);
        Lanes<Number>::store(lambda * g[a][i], K.lambda_g[a][i]);
        Lanes<Number>::store(mu * g[a][i], K.mu_g[a][i]);
      }
      for (int b = 0; b <= a; ++b)
        Lanes<Number>::store(mu * dot(g[a], g[b]), K.diagonal[a][b]);
    }
  }

  /// Add V (lambda g_a g_b^T + mu (g_b g_a^T + (g_a.g_b) I)) of one cell, with g its rotated
  /// gradients, of which the fourth entry is 0.
  template <typename Number>
  [[gnu::always_inline]] inline void
  add_stiffness(const RotatedStiffness<Number> &K,
                const std::size_t               lane,
                const Four (&g)[4],
                const int *position,
                double    *values)
  {
    const Four unit[3] = { { 1., 0., 0., 0. }, { 0., 1., 0., 0. }, { 0., 0., 1., 0. } };
    const Four rows[3] = { { 1., 1., 1., 0. }, { 0., 1., 1., 0. }, { 0., 0., 1., 0. } };
#pragma GCC unroll 4
    for (int a = 0; a < 4; ++a)
#pragma GCC unroll 4
      for (int b = 0; b <= a; ++b)
      {
        const int *column = position + 3 * (a * (a + 1) / 2 + b);
        if (column[0] < 0) // then all three are left out
          continue;
#pragma GCC unroll 3
        for (int j = 0; j < 3; ++j)
        {
          Four entries = g[a] * K.lambda_g[b][j][lane] + g[b] * K.mu_g[a][j][lane]
                         + unit[j] * K.diagonal[a][b][lane];
          if (a == b)
            entries *= rows[j]; // of diagonal blocks, the lower triangle alone
          add_four(entries, values + column[j]);
        }
      }
  }

  /// The rotated gradients a of some cells, each filled up to four numbers by a zero.
  template <typename Number>
  [[gnu::always_inline]] inline void
  gradients_by_cell(const RotatedStiffness<Number> &K,
                    const std::size_t               first,
                    const int                       a,
                    Four (&g)[4])
  {
    if constexpr (LaneGroup<Number>::width >= 4)
    {
      for (int i = 0; i < 3; ++i)
        load_four(K.g[a][i] + first, g[i]);
      g[3] = Four{};
      transpose(g);
    }
    else
      for (std::size_t l = 0; l < LaneGroup<Number>::width; ++l)
        g[l] = Four{ K.g[a][0][l], K.g[a][1][l], K.g[a][2][l], 0. };
  }

  template <typename Number>
  inline void
  add_rotated_stiffness(const CellTask    &task,
                        const TangentTask &tangent,
                        const std::size_t  begin,
                        const std::size_t  end)
  {
    RotatedStiffness<Number> K;
    for_each_group<Number>(
        begin, end,
        [&](const LaneGroup<Number> &group)
        {
          find_rotated_stiffness(task, group, K);
          constexpr std::size_t at_once = std::min<std::size_t>(4, LaneGroup<Number>::width);
          for (std::size_t first = 0; first < LaneGroup<Number>::width; first += at_once)
          {
            Four g[4][4]; // of node a, by cell
            for (int a = 0; a < 4; ++a)
              gradients_by_cell(K, first, a, g[a]);
            for (std::size_t l = 0; l < at_once; ++l)
            {
              const std::size_t cell = group.cell(first + l);
              if (cell >= task.cells.n_cells)
                return;
              const Four g_of_cell[4] = { g[0][l], g[1][l], g[2][l], g[3][l] };
              add_stiffness(K, first + l, g_of_cell,
                            tangent.positions + n_block_columns * (cell - begin * batch_size),
                            tangent.values);
            }
          }
        });
  }
} // namespace Exemplar::Loops

#endif
