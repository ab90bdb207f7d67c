// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_edges_h
#define exemplar_mesh_edges_h

#include <array>
#include <vector>

namespace Exemplar
{
  /// The corners of a tetrahedron between which its edges are, in the order of deal.II and of VTK,
  /// which gmsh has, too, but for the last two.
  constexpr unsigned int cell_edges[6][2]
      = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };

  /// The edges of a mesh by their nodes, the lesser one first, each once and in ascending order.
  std::vector<std::array<unsigned int, 2>>
  edges_of(const std::vector<std::array<unsigned int, 4>> &cells);

  /// The number among them of the edge between two nodes, which must be there.
  unsigned int
  find_edge(const std::vector<std::array<unsigned int, 2>> &edges, unsigned int a, unsigned int b);
} // namespace Exemplar

#endif
