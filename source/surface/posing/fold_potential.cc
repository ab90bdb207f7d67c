// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/loop_parts.h>
#include <exemplar/kernels/polar_decomposition.h>
#include <exemplar/surface/posing/fold_energy.h>
#include <exemplar/surface/posing/fold_potential.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// A cell at rest, with its volume [m^3].
    Tetrahedron<double>
    tetrahedron_at_rest(const FoldPotential::Points &nodes, const std::array<unsigned int, 4> &cell)
    {
      Matrix3<double> edges; // edge vectors as columns
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 3; ++d)
          edges[d][a] = nodes[cell[a + 1]][d] - nodes[cell[0]][d];
      const double          det = determinant(edges);
      const Matrix3<double> cof = cofactors(edges);
      Tetrahedron<double>   result{};
      result.volume = det / 6.;
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 3; ++d)
        {
          result.shape_gradient[a + 1][d] = cof[d][a] / det;
          result.shape_gradient[0][d] -= cof[d][a] / det;
        }
      return result;
    }

    /// Lower bound of the eigenvalues of the energy's Hessian by F in a Newton step; those of
    /// strains at rest are of order 1. Flatter and concave modes would make the step long without
    /// making it better.
    constexpr double min_stiffness = 1e-3;

    /// Number of cells below which threads would wait for each other longer than they work.
    constexpr std::size_t few_cells = 2000;

    /// Number of cells whose stiffness is held in memory at a time.
    constexpr std::size_t n_at_once = 4096;
  } // namespace

  FoldPotential::FoldPotential(const Points      &nodes,
                               const Cells       &cells,
                               const unsigned int n_threads)
      : attachment{ std::vector<double>(nodes.size(), 0.), nodes },
        n_threads(cells.size() < few_cells ? 1 : n_threads), cells(cells)
  {
    for (const auto &cell : cells)
    {
      rest.push_back(tetrahedron_at_rest(nodes, cell));
      volume += rest.back().volume;
    }
    for (Tetrahedron<double> &cell : rest)
      cell.volume /= volume;
    build_pattern(nodes.size());
  }

  void
  FoldPotential::build_pattern(const std::size_t n_nodes)
  {
    std::vector<std::vector<int>> rows(n_nodes);
    for (const auto &cell : cells)
      for (const unsigned int i : cell)
        for (const unsigned int j : cell)
          if (i >= j)
            rows[j].push_back(static_cast<int>(i));
    pattern.column_start = { 0 };
    for (auto &column : rows)
    {
      std::sort(column.begin(), column.end());
      column.erase(std::unique(column.begin(), column.end()), column.end());
      pattern.row.insert(pattern.row.end(), column.begin(), column.end());
      pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
    }
    for (const auto &cell : cells)
    {
      std::array<int, 10> of_cell;
      int                 pair = 0;
      for (int a = 0; a < 4; ++a)
        for (int b = a; b < 4; ++b)
          of_cell[pair++] = pattern.position(static_cast<int>(std::max(cell[a], cell[b])),
                                             static_cast<int>(std::min(cell[a], cell[b])));
      positions.push_back(of_cell);
    }
  }

  SymmetricPattern
  FoldPotential::block_pattern() const
  {
    SymmetricPattern blocks;
    blocks.column_start = { 0 };
    for (unsigned int j = 0; j < pattern.n(); ++j)
      for (int c = 0; c < 3; ++c)
      {
        for (int p = pattern.column_start[j]; p < pattern.column_start[j + 1]; ++p)
          for (int r = (pattern.row[p] == static_cast<int>(j) ? c : 0); r < 3; ++r)
            blocks.row.push_back(3 * pattern.row[p] + r);
        blocks.column_start.push_back(static_cast<int>(blocks.row.size()));
      }
    return blocks;
  }

  Matrix3<double>
  FoldPotential::gradient_of_cell(const Points &x, const std::size_t cell) const
  {
    Vector3<double> corners[4];
    for (int a = 0; a < 4; ++a)
      for (int d = 0; d < 3; ++d)
        corners[a][d] = x[cells[cell][a]][d];
    return deformation_gradient(rest[cell], corners);
  }

  /// The values function(c) of all cells c, by threads: sums over them are then made in the order
  /// of the cells.
  template <typename Value, typename Function>
  std::vector<Value>
  FoldPotential::of_cells(const Function &function) const
  {
    std::vector<Value> result(cells.size());
    for_each_part(n_threads, cells.size(), static_cast<int>(n_threads),
                  [&](std::size_t, const std::size_t begin, const std::size_t end)
                  {
                    for (std::size_t c = begin; c < end; ++c)
                      result[c] = function(c);
                  });
    return result;
  }

  double
  FoldPotential::value(const Points &x, const double eps) const
  {
    double sum = 0.;
    for (const double of_cell :
         of_cells<double>([&](const std::size_t c)
                          { return rest[c].volume * fold_energy(gradient_of_cell(x, c), eps); }))
      sum += of_cell;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += 0.5 * attachment.stiffness[i] * x[i].distance_square(attachment.target[i]);
    return sum + skin.energy(x);
  }

  std::vector<double>
  FoldPotential::gradient(const Points &x, const double eps) const
  {
    const auto stresses = of_cells<Matrix3<double>>(
        [&](const std::size_t c) { return fold_stress(gradient_of_cell(x, c), eps); });
    std::vector<double> result(3 * x.size(), 0.);
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (int a = 0; a < 4; ++a)
      {
        const Vector3<double> force = stresses[c] * rest[c].shape_gradient[a];
        for (int d = 0; d < 3; ++d)
          result[3 * cells[c][a] + d] += rest[c].volume * force[d];
      }
    for (std::size_t i = 0; i < x.size(); ++i)
      for (int d = 0; d < 3; ++d)
        result[3 * i + d] += attachment.stiffness[i] * (x[i][d] - attachment.target[i][d]);
    skin.add_gradient(x, result);
    return result;
  }

  std::vector<double>
  FoldPotential::determinants(const Points &x) const
  {
    return of_cells<double>([&](const std::size_t c)
                            { return determinant(gradient_of_cell(x, c)); });
  }

  /// Adds the block of a pair of nodes at `position` of the node pattern, in column j; see
  /// block_pattern().
  void
  FoldPotential::add_to_block(const int              position,
                              const int              j,
                              const Matrix3<double> &block,
                              std::vector<double>   &values) const
  {
    const int begin = pattern.column_start[j], n_rows = pattern.column_start[j + 1] - begin;
    const int first = 9 * begin - 3 * j, row = position - begin;
    for (int c = 0; c < 3; ++c)
    {
      const int column = first + 3 * n_rows * c - (c == 2 ? 1 : 0);
      for (int r = (row == 0 ? c : 0); r < 3; ++r)
        values[column + 3 * row + r - c] += block[r][c];
    }
  }

  FoldPotential::CellBlocks
  FoldPotential::blocks_of_cell(const std::size_t c, const Points &x, const double eps) const
  {
    const FoldModes modes = fold_modes(gradient_of_cell(x, c), eps);
    double          pushes[9][4][3]; // derivative of a mode by the place of a node
    double          stiffness[9];
    for (int m = 0; m < 9; ++m)
    {
      stiffness[m] = rest[c].volume * std::max(modes.stiffness[m], min_stiffness);
      for (int a = 0; a < 4; ++a)
      {
        const Vector3<double> push = modes.direction[m] * rest[c].shape_gradient[a];
        std::copy(push.value, push.value + 3, pushes[m][a]);
      }
    }
    CellBlocks result{};
    int        pair = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = a; b < 4; ++b, ++pair)
      {
        const bool a_first = cells[c][a] >= cells[c][b];
        const int  i = a_first ? a : b, j = a_first ? b : a;
        for (int m = 0; m < 9; ++m)
          for (int r = 0; r < 3; ++r)
            for (int s = 0; s < 3; ++s)
              result[pair][r][s] += stiffness[m] * pushes[m][i][r] * pushes[m][j][s];
      }
    return result;
  }

  void
  FoldPotential::add_cell(const std::size_t    c,
                          const CellBlocks    &blocks,
                          std::vector<double> &values) const
  {
    int pair = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = a; b < 4; ++b, ++pair)
        add_to_block(positions[c][pair], static_cast<int>(std::min(cells[c][a], cells[c][b])),
                     blocks[pair], values);
  }

  void
  FoldPotential::assemble(const Points &x, const double eps, std::vector<double> &values) const
  {
    std::fill(values.begin(), values.end(), 0.);
    std::vector<CellBlocks> blocks(std::min(n_at_once, cells.size()));
    for (std::size_t first = 0; first < cells.size(); first += n_at_once)
    {
      const std::size_t n = std::min(n_at_once, cells.size() - first);
      for_each_part(n_threads, n, static_cast<int>(n_threads),
                    [&](std::size_t, const std::size_t begin, const std::size_t end)
                    {
                      for (std::size_t k = begin; k < end; ++k)
                        blocks[k] = blocks_of_cell(first + k, x, eps);
                    });
      for (std::size_t k = 0; k < n; ++k)
        add_cell(first + k, blocks[k], values);
    }
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      Matrix3<double> block{};
      for (int d = 0; d < 3; ++d)
        block[d][d] = attachment.stiffness[i];
      add_to_block(pattern.column_start[i], static_cast<int>(i), block, values);
    }
  }

  void
  FoldPotential::assemble_rotations(std::vector<double> &values) const
  {
    std::fill(values.begin(), values.end(), 0.);
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      const auto &g    = rest[c].shape_gradient;
      int         pair = 0;
      for (int a = 0; a < 4; ++a)
        for (int b = a; b < 4; ++b)
          values[positions[c][pair++]] += 2. * rest[c].volume * dot(g[a], g[b]);
    }
    for (unsigned int i = 0; i < pattern.n(); ++i)
      values[pattern.column_start[i]] += attachment.stiffness[i];
  }

  std::vector<double>
  FoldPotential::rotated_rest(const Points *x) const
  {
    const std::size_t n         = pattern.n();
    const auto        rotations = of_cells<Matrix3<double>>(
        [&](const std::size_t c) {
          return x == nullptr ? identity_matrix<double>()
                                     : closest_rotation(gradient_of_cell(*x, c));
        });
    std::vector<double> result(3 * n, 0.);
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (int a = 0; a < 4; ++a)
      {
        const Vector3<double> force = rotations[c] * rest[c].shape_gradient[a];
        for (int d = 0; d < 3; ++d)
          result[d * n + cells[c][a]] += 2. * rest[c].volume * force[d];
      }
    for (std::size_t i = 0; i < n; ++i)
      for (int d = 0; d < 3; ++d)
        result[d * n + i] += attachment.stiffness[i] * attachment.target[i][d];
    return result;
  }
} // namespace Exemplar
