// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/surface_paths.h>
#include <exemplar/surface/shape/vectors.h>

#include <algorithm>
#include <limits>
#include <map>
#include <queue>

namespace Exemplar
{
  namespace
  {
    constexpr double infinite = std::numeric_limits<double>::infinity();
  }

  SurfacePaths::SurfacePaths(const TriangleSurface           &on,
                             const std::vector<unsigned int> &sources,
                             const double                     maximum)
      : surface(on), limit(maximum)
  {
    number_points(sources);
    search();
  }

  void
  SurfacePaths::number_points(const std::vector<unsigned int> &sources)
  {
    std::map<SurfaceMesh::Vertex, unsigned int> first_at;
    for (unsigned int v = 0; v < surface.vertices.size(); ++v)
      same.push_back(first_at.emplace(surface.vertices[v], v).first->second);
    for (const auto &t : surface.triangles)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const unsigned int a = same[t[i]], b = same[t[(i + 1) % 3]];
        edges.push_back({ { std::min(a, b), std::max(a, b) } });
      }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const auto &t : surface.triangles)
    {
      around.emplace_back();
      auto next = around.back().begin();
      for (unsigned int i = 0; i < 3; ++i)
      {
        *next++ = same[t[i]];
        for (unsigned int k = 0; k < n_between; ++k)
          *next++ = point_on_edge(same[t[i]], same[t[(i + 1) % 3]], k);
      }
    }
    distances.assign(surface.vertices.size() + n_between * edges.size(), infinite);
    for (const unsigned int source : sources)
      distances[same[source]] = 0.;
  }

  unsigned int
  SurfacePaths::point_on_edge(const unsigned int a,
                              const unsigned int b,
                              const unsigned int k) const
  {
    const std::array<unsigned int, 2> edge{ { std::min(a, b), std::max(a, b) } };
    const auto                        found = std::lower_bound(edges.begin(), edges.end(), edge);
    return static_cast<unsigned int>(surface.vertices.size() + n_between * (found - edges.begin()))
           + k;
  }

  SurfaceMesh::Vertex
  SurfacePaths::place(const unsigned int point) const
  {
    const auto n = static_cast<unsigned int>(surface.vertices.size());
    if (point < n)
      return surface.vertices[point];
    const auto &[a, b] = edges[(point - n) / n_between];
    const double share = ((point - n) % n_between + 1.) / (n_between + 1.);
    const auto  &x     = surface.vertices[a];
    return plus(x, share, minus(surface.vertices[b], x));
  }

  // Dijkstra's algorithm, on the graph that links all points around each triangle.
  void
  SurfacePaths::search()
  {
    std::vector<std::size_t> begin(distances.size() + 1, 0); // of the triangles at each point
    for (const auto &points : around)
      for (const unsigned int point : points)
        ++begin[point + 1];
    for (std::size_t p = 0; p + 1 < begin.size(); ++p)
      begin[p + 1] += begin[p];
    std::vector<unsigned int> triangles(begin.back());
    std::vector<std::size_t>  next(begin.begin(), begin.end() - 1);
    for (unsigned int t = 0; t < around.size(); ++t)
      for (const unsigned int point : around[t])
        triangles[next[point]++] = t;

    using Entry = std::pair<double, unsigned int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (unsigned int point = 0; point < surface.vertices.size(); ++point)
      if (distances[point] == 0.)
        queue.emplace(0., point);
    while (!queue.empty())
    {
      const auto [distance, point] = queue.top();
      queue.pop();
      if (distance > distances[point])
        continue;
      const SurfaceMesh::Vertex from = place(point);
      for (std::size_t i = begin[point]; i < begin[point + 1]; ++i)
        for (const unsigned int other : around[triangles[i]])
        {
          const double there = distance + norm(minus(place(other), from));
          if (there < distances[other] && there <= limit)
            queue.emplace(distances[other] = there, other);
        }
    }
  }

  double
  SurfacePaths::distance(const SurfacePoint &point) const
  {
    const auto         &t = surface.triangles[point.triangle];
    SurfaceMesh::Vertex at{ { 0., 0., 0. } };
    for (unsigned int a = 0; a < 3; ++a)
      at = plus(at, point.share[a], surface.vertices[t[a]]);
    double minimum = infinite;
    for (const unsigned int other : around[point.triangle])
      minimum = std::min(minimum, distances[other] + norm(minus(place(other), at)));
    return minimum <= limit ? minimum : infinite;
  }
} // namespace Exemplar
