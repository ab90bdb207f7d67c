// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/skin/own_sheets.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    using Edge  = std::array<unsigned int, 2>;
    using Edges = std::vector<Edge>;

    Edges
    edges_of(const SurfaceMesh &surface)
    {
      Edges edges;
      for (const auto &face : surface.faces)
        for (std::size_t i = 0; i < face.size(); ++i)
        {
          const unsigned int a = face[i], b = face[(i + 1) % face.size()];
          edges.push_back({ { std::min(a, b), std::max(a, b) } });
        }
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      return edges;
    }

    /// Connected components of edges: for each vertex the smallest one of its component.
    std::vector<unsigned int>
    joined(const std::size_t n_vertices, const Edges &edges)
    {
      std::vector<unsigned int> parent(n_vertices);
      std::iota(parent.begin(), parent.end(), 0U);
      const auto root = [&parent](unsigned int v)
      {
        while (parent[v] != v)
          v = parent[v] = parent[parent[v]];
        return v;
      };
      for (const auto &[a, b] : edges)
      {
        const unsigned int i = root(a), j = root(b);
        parent[std::max(i, j)] = std::min(i, j);
      }
      for (unsigned int v = 0; v < n_vertices; ++v)
        parent[v] = root(v);
      return parent;
    }

    /// Whether a vertex is of the largest sheet of its part.
    std::vector<bool>
    of_largest_sheets(const std::vector<unsigned int> &part, const std::vector<unsigned int> &sheet)
    {
      std::vector<std::size_t> size(sheet.size(), 0);
      for (const unsigned int s : sheet)
        ++size[s];
      std::vector<unsigned int> largest = part; // largest sheet of each part, at its first vertex
      for (unsigned int v = 0; v < sheet.size(); ++v)
        if (size[sheet[v]] > size[largest[part[v]]])
          largest[part[v]] = sheet[v];
      std::vector<bool> is_right(sheet.size());
      for (unsigned int v = 0; v < sheet.size(); ++v)
        is_right[v] = sheet[v] == largest[part[v]];
      return is_right;
    }
  } // namespace

  void
  put_on_own_sheets(
      const SurfaceMesh                                                          &surface,
      const std::function<bool(unsigned int, unsigned int)>                      &is_broken,
      const std::function<void(unsigned int, const std::vector<unsigned int> &)> &move_beside)
  {
    const Edges edges = edges_of(surface);
    Edges       whole;
    std::copy_if(edges.begin(), edges.end(), std::back_inserter(whole),
                 [&](const Edge &edge) { return !is_broken(edge[0], edge[1]); });
    if (whole.size() == edges.size())
      return;
    const std::size_t n        = surface.vertices.size();
    std::vector<bool> is_right = of_largest_sheets(joined(n, edges), joined(n, whole));
    while (true)
    {
      std::map<unsigned int, std::vector<unsigned int>> next; // to move, with right neighbours
      for (const auto &[a, b] : edges)
        if (is_right[a] != is_right[b])
          next[is_right[a] ? b : a].push_back(is_right[a] ? a : b);
      if (next.empty())
        return;
      for (const auto &[vertex, right] : next)
      {
        move_beside(vertex, right);
        is_right[vertex] = true;
      }
    }
  }
} // namespace Exemplar
