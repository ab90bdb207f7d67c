// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_stiffness_h
#define exemplar_loops_stiffness_h

#include <exemplar/kernels/loops_blocks.h>

// The loop that adds R K R^T, Eq. (8), of isotropic materials, whose stiffness is rotated by
// rotating the shape gradients of a cell.

namespace Exemplar::Loops
{
  /// Factors of R K R^T in the cells of a group, Eq. (8), for an isotropic material. Lanes are
  /// stored, because each cell is then added by itself.
  template <typename Number, int n>
  struct RotatedStiffness
  {
    alignas(64) double g[n][3][LaneGroup<Number>::width];        ///< R g_a
    alignas(64) double lambda_g[n][3][LaneGroup<Number>::width]; ///< V lambda R g_a
    alignas(64) double mu_g[n][3][LaneGroup<Number>::width];     ///< V mu R g_a
    alignas(64) double diagonal[n][n][LaneGroup<Number>::width]; ///< V mu g_a.g_b, a >= b
  };

  template <typename Number, int n>
  inline void
  find_rotated_stiffness(const CellTask              &task,
                         const std::size_t            n_constants,
                         const LaneGroup<Number>     &group,
                         RotatedStiffness<Number, n> &K)
  {
    const auto            tet    = load_tetrahedron<n>(task.cells, group);
    const Matrix3<Number> R      = load_rotation(task.cells, group);
    Number                factor = tet.volume;
    if (task.damping.factors != nullptr)
      factor *= Number(1.) + load(task.damping.factors, group, 1, 0);
    const CellMaterial<Number> C
        = CellMaterial<Number>{ load(task.cells.constants, group, n_constants, 0),
                                load(task.cells.constants, group, n_constants, 1) }
              .scaled(factor);
    Vector3<Number> g[n];
    rotate_gradients(tet, R, g);
    for (int a = 0; a < n; ++a)
    {
      for (int i = 0; i < 3; ++i)
      {
        Lanes<Number>::store(g[a][i], K.g[a][i]);
        Lanes<Number>::store(C.lambda * g[a][i], K.lambda_g[a][i]);
        Lanes<Number>::store(C.mu * g[a][i], K.mu_g[a][i]);
      }
      for (int b = 0; b <= a; ++b)
        Lanes<Number>::store(C.mu * dot(g[a], g[b]), K.diagonal[a][b]);
    }
  }

  /// Add V (lambda g_a g_b^T + mu (g_b g_a^T + (g_a.g_b) I)) summed over `n_points` points of one
  /// cell, from that in `lane` on, where g are their rotated gradients, padded by a 0.
  template <typename Number, int n, std::size_t n_points>
  [[gnu::always_inline]] inline void
  add_stiffness(const RotatedStiffness<Number, n> &K,
                const std::size_t                  lane,
                const Four (&g)[n][n_points],
                const int *position,
                double    *values)
  {
    const Four unit[3] = { { 1., 0., 0., 0. }, { 0., 1., 0., 0. }, { 0., 0., 1., 0. } };
    const Four rows[3] = { { 1., 1., 1., 0. }, { 0., 1., 1., 0. }, { 0., 0., 1., 0. } };
#pragma GCC unroll 4
    for (int a = 0; a < n; ++a)
#pragma GCC unroll 4
      for (int b = 0; b <= a; ++b)
      {
        const int *column = position + 3 * (a * (a + 1) / 2 + b);
        if (column[0] < 0) // all three columns are left out
          continue;
#pragma GCC unroll 3
        for (int j = 0; j < 3; ++j)
        {
          Four entries = g[a][0] * K.lambda_g[b][j][lane] + g[b][0] * K.mu_g[a][j][lane]
                         + unit[j] * K.diagonal[a][b][lane];
          for (std::size_t p = 1; p < n_points; ++p)
            entries += g[a][p] * K.lambda_g[b][j][lane + p] + g[b][p] * K.mu_g[a][j][lane + p]
                       + unit[j] * K.diagonal[a][b][lane + p];
          if (a == b)
            entries *= rows[j]; // only the lower triangle of diagonal blocks
          add_four(entries, values + column[j]);
        }
      }
  }

  /// The rotated gradients of node a in four cells, each padded by a 0.
  template <typename Number, int n>
  [[gnu::always_inline]] inline void
  gradients_by_cell(const RotatedStiffness<Number, n> &K,
                    const std::size_t                  first,
                    const int                          a,
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

  /// Add R K R^T of a law with `n_constants` constants, the first of which are Lamé's.
  template <typename Number, int n>
  inline void
  add_isotropic_stiffness(const CellTask    &task,
                          const std::size_t  n_constants,
                          const TangentTask &tangent,
                          const std::size_t  begin,
                          const std::size_t  end)
  {
    // points of one cell in one register are added together
    constexpr std::size_t at_once  = std::min<std::size_t>(4, LaneGroup<Number>::width);
    constexpr std::size_t n_points = std::min(at_once, points_of_cell(n));

    RotatedStiffness<Number, n> K;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          find_rotated_stiffness(task, n_constants, group, K);
          for (std::size_t first = 0; first < LaneGroup<Number>::width; first += at_once)
          {
            Four g[n][4]; // gradients by node a and cell
            for (int a = 0; a < n; ++a)
              gradients_by_cell(K, first, a, g[a]);
            for (std::size_t l = 0; l < at_once; l += n_points)
            {
              const std::size_t cell = group.cell(first + l);
              if (cell >= task.cells.n_cells)
                return;
              Four g_of_cell[n][n_points];
              for (int a = 0; a < n; ++a)
                for (std::size_t p = 0; p < n_points; ++p)
                  g_of_cell[a][p] = g[a][l + p];
              add_stiffness(K, first + l, g_of_cell, matrix_positions<n>(tangent, begin, cell),
                            tangent.values);
            }
          }
        });
  }
} // namespace Exemplar::Loops

#endif
