// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/surface_edges.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace Exemplar
{
  std::vector<TriangleSide>
  sorted_sides(const TriangleSurface &surface)
  {
    std::vector<TriangleSide> sides;
    sides.reserve(3 * surface.triangles.size());
    for (unsigned int t = 0; t < surface.triangles.size(); ++t)
      for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
        if (a != b)
          sides.push_back({ { { std::min(a, b), std::max(a, b) } }, t, k, a < b });
      }
    std::sort(sides.begin(), sides.end(),
              [](const TriangleSide &a, const TriangleSide &b)
              { return std::tie(a.vertices, a.triangle) < std::tie(b.vertices, b.triangle); });
    return sides;
  }

  UnionFind::UnionFind(const std::size_t n) : parent(n)
  {
    std::iota(parent.begin(), parent.end(), 0U);
  }

  unsigned int
  UnionFind::root(unsigned int i)
  {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  }

  void
  UnionFind::join(unsigned int i, unsigned int j)
  {
    i                      = root(i);
    j                      = root(j);
    parent[std::max(i, j)] = std::min(i, j);
  }

  unsigned int
  UnionFind::number(std::vector<unsigned int> &sets)
  {
    unsigned int n = 0;
    sets.resize(parent.size());
    for (unsigned int i = 0; i < parent.size(); ++i)
      sets[i] = root(i) == i ? n++ : sets[root(i)];
    return n;
  }

  unsigned int
  number_shells(const TriangleSurface           &surface,
                const std::vector<TriangleSide> &sides,
                std::vector<unsigned int>       &shells)
  {
    UnionFind together(surface.triangles.size());
    for (std::size_t i = 1; i < sides.size(); ++i)
      if (sides[i].vertices == sides[i - 1].vertices)
        together.join(sides[i].triangle, sides[i - 1].triangle);
    return together.number(shells);
  }

  TriangleSurface
  shell_of(const TriangleSurface           &surface,
           const std::vector<unsigned int> &shells,
           const unsigned int               shell)
  {
    TriangleSurface result{ surface.vertices, {}, {} };
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      if (shells[t] == shell)
      {
        result.triangles.push_back(surface.triangles[t]);
        result.groups.push_back(surface.groups[t]);
      }
    return result;
  }
} // namespace Exemplar
