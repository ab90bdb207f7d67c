// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_edges_h
#define exemplar_mesh_edges_h

#include <array>
#include <vector>

namespace Exemplar
{
  /// The corners at the ends of a tetrahedron's edges, in the order of deal.II and of VTK, and of
  /// gmsh except for the last two.
  constexpr unsigned int cell_edges[6][2]
      = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };

  /// The edges of a mesh by their nodes, the lesser one first, each once and in ascending order.
  std::vector<std::array<unsigned int, 2>>
  edges_of(const std::vector<std::array<unsigned int, 4>> &cells);

  /// The same of triangles.
  std::vector<std::array<unsigned int, 2>>
  edges_of(const std::vector<std::array<unsigned int, 3>> &triangles);

  /// Index in edges_of() of the edge between two nodes, which must exist.
  unsigned int
  find_edge(const std::vector<std::array<unsigned int, 2>> &edges, unsigned int a, unsigned int b);
} // namespace Exemplar

#endif
