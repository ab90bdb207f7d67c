// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh_edges.h>

#include <algorithm>
#include <iterator>

namespace Exemplar
{
  namespace
  {
    std::array<unsigned int, 2>
    ascending(const unsigned int a, const unsigned int b)
    {
      return { { std::min(a, b), std::max(a, b) } };
    }

    void
    sort_and_unite(std::vector<std::array<unsigned int, 2>> &edges)
    {
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    }
  } // namespace

  std::vector<std::array<unsigned int, 2>>
  edges_of(const std::vector<std::array<unsigned int, 4>> &cells)
  {
    std::vector<std::array<unsigned int, 2>> edges;
    edges.reserve(std::size(cell_edges) * cells.size());
    for (const auto &cell : cells)
      for (const auto &[a, b] : cell_edges)
        edges.push_back(ascending(cell[a], cell[b]));
    sort_and_unite(edges);
    return edges;
  }

  std::vector<std::array<unsigned int, 2>>
  edges_of(const std::vector<std::array<unsigned int, 3>> &triangles)
  {
    std::vector<std::array<unsigned int, 2>> edges;
    edges.reserve(3 * triangles.size());
    for (const auto &[a, b, c] : triangles)
      for (const auto &edge : { ascending(a, b), ascending(b, c), ascending(c, a) })
        edges.push_back(edge);
    sort_and_unite(edges);
    return edges;
  }

  unsigned int
  find_edge(const std::vector<std::array<unsigned int, 2>> &edges,
            const unsigned int                              a,
            const unsigned int                              b)
  {
    const auto edge = std::lower_bound(edges.begin(), edges.end(), ascending(a, b));
    return static_cast<unsigned int>(edge - edges.begin());
  }
} // namespace Exemplar
