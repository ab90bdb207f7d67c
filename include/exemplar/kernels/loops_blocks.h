// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_blocks_h
#define exemplar_loops_blocks_h

#include <exemplar/kernels/loops_io.h>

#include <algorithm>

// The matrix of a cell, block by block, from the response of its force to changes of F, and its
// addition to the global one.

namespace Exemplar::Loops
{
  /// Positions of the columns of a cell's matrix (sum over its points), if batch `begin` is the
  /// first.
  template <int n_nodes>
  inline const int *
  matrix_positions(const TangentTask &tangent, const std::size_t begin, const std::size_t cell)
  {
    return tangent.positions
           + n_block_columns(n_nodes) * ((cell - begin * batch_size) / points_of_cell(n_nodes));
  }

  /// The blocks of the cells of a group: three columns each, with space for four rows.
  template <typename Number, int n_nodes>
  using BlockColumns = double[n_block_columns(n_nodes)][4][LaneGroup<Number>::width];

  /// Blocks d f_a / d x_b of the cells of a group.
  template <typename Number, int n_nodes>
  inline void
  cell_blocks(const LawTangent<Number>           &tangent,
              const Matrix3<Number>              &R,
              const Tetrahedron<Number, n_nodes> &tet,
              BlockColumns<Number, n_nodes>      &columns)
  {
    Matrix3<Number> VR = R;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        VR[i][j] *= tet.volume;
    // responses to unit displacements of node b along axes k of the rotated frame, which are
    // combined to those along axes j of space
    for (int b = 0; b < n_nodes; ++b)
    {
      const Vector3<Number> &g = tet.shape_gradient[b];
      Matrix3<Number>        response[3];
      for (int k = 0; k < 3; ++k)
      {
        const Matrix3<Number>(&of)[3] = tangent.of[k];
        Matrix3<Number> dP;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            dP[i][j] = of[0][i][j] * g[0] + of[1][i][j] * g[1] + of[2][i][j] * g[2];
        response[k] = VR * dP;
      }
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

  /// Add the matrices of the cells of a group, summed over the points of a cell.
  template <typename Number, int n_nodes>
  inline void
  add_blocks(const CellTask                      &task,
             const TangentTask                   &tangent,
             const std::size_t                    begin,
             const LaneGroup<Number>             &group,
             const BlockColumns<Number, n_nodes> &columns)
  {
    constexpr std::size_t n_points = std::min(LaneGroup<Number>::width, points_of_cell(n_nodes));
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
  }
} // namespace Exemplar::Loops

#endif
