// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/filling/cell_angles.h>

#include <algorithm>

namespace Exemplar
{
  std::pair<double, double>
  dihedral_angles(const std::array<SpaceVector, 4> &p)
  {
    const double              degrees = 180. / std::acos(-1.);
    std::pair<double, double> angles{ 180., 0. };
    // the edge from i to j, and the two other corners
    constexpr unsigned int edges[6][4]{ { 0, 1, 2, 3 }, { 0, 2, 1, 3 }, { 0, 3, 1, 2 },
                                        { 1, 2, 0, 3 }, { 1, 3, 0, 2 }, { 2, 3, 0, 1 } };
    for (const auto &[i, j, k, l] : edges)
    {
      const SpaceVector edge = minus(p[j], p[i]);
      const SpaceVector a = cross(edge, minus(p[k], p[i])), b = cross(edge, minus(p[l], p[i]));
      const double      angle = degrees * std::atan2(norm(cross(a, b)), dot(a, b));
      angles                  = { std::min(angles.first, angle), std::max(angles.second, angle) };
    }
    return angles;
  }

  std::array<SpaceVector, 4>
  corners_of(const TetrahedralMesh &mesh, const std::size_t cell)
  {
    std::array<SpaceVector, 4> corners;
    for (unsigned int k = 0; k < 4; ++k)
      corners[k] = mesh.nodes[mesh.cells[cell][k]];
    return corners;
  }

  CellAngles
  measure_angles(const TetrahedralMesh &mesh)
  {
    std::vector<bool> on_boundary(mesh.nodes.size(), false);
    for (const auto &t : mesh.boundary.triangles)
      for (const unsigned int node : t)
        on_boundary[node] = true;
    CellAngles          result;
    std::vector<double> smallest;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    {
      const auto [low, high] = dihedral_angles(corners_of(mesh, c));
      smallest.push_back(low);
      result.largest = std::max(result.largest, high);
      if (low >= sliver_angle)
        continue;
      ++result.n_slivers;
      if (std::any_of(mesh.cells[c].begin(), mesh.cells[c].end(),
                      [&](const unsigned int node) { return on_boundary[node]; }))
        ++result.n_boundary_slivers;
    }
    std::sort(smallest.begin(), smallest.end());
    result.smallest     = smallest.front();
    result.percentile_1 = smallest[smallest.size() / 100];
    result.median       = smallest[smallest.size() / 2];
    return result;
  }
} // namespace Exemplar
