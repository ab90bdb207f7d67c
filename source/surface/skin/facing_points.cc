// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/skin/facing_points.h>

#include <algorithm>
#include <map>

namespace Exemplar
{
  namespace
  {
    constexpr SpaceVector nowhere{ { 0., 0., 0. } };

    /// The unit normal of a triangle; 0 if it has no area.
    SpaceVector
    triangle_normal(const TriangleSurface &surface, const unsigned int triangle)
    {
      const auto       &t = surface.triangles[triangle];
      const SpaceVector n = cross(minus(surface.vertices[t[1]], surface.vertices[t[0]]),
                                  minus(surface.vertices[t[2]], surface.vertices[t[0]]));
      const double      l = norm(n);
      return l > 0. ? plus(nowhere, 1. / l, n) : nowhere;
    }

    /// One of the 26 directions to the neighbours in a grid, or none.
    using GridDirection = std::array<int, 3>;

    GridDirection
    grid_direction(const SpaceVector &normal)
    {
      GridDirection direction;
      for (int c = 0; c < 3; ++c) // threshold: sin(22.5 degrees)
        direction[c] = normal[c] > .383 ? 1 : normal[c] < -.383 ? -1 : 0;
      return direction;
    }

    /// Some triangles of a surface, with its vertices.
    struct PartOfSurface
    {
      TriangleSurface           surface;
      std::vector<unsigned int> number; ///< numbers of the triangles in the whole
    };

    /// The triangles that face about this way.
    PartOfSurface
    facing(const TriangleSurface &surface, const GridDirection &direction)
    {
      SpaceVector along{ { double(direction[0]), double(direction[1]), double(direction[2]) } };
      along = plus(nowhere, 1. / norm(along), along);
      PartOfSurface part{ { surface.vertices, {}, {} }, {} };
      for (unsigned int t = 0; t < surface.triangles.size(); ++t)
        if (dot(triangle_normal(surface, t), along) > .5)
        {
          part.surface.triangles.push_back(surface.triangles[t]);
          part.number.push_back(t);
        }
      return part;
    }

    double
    longest_edge(const TriangleSurface &surface, const unsigned int triangle)
    {
      const auto &t      = surface.triangles[triangle];
      double      length = 0.;
      for (int a = 0; a < 3; ++a)
        length = std::max(length,
                          norm(minus(surface.vertices[t[a]], surface.vertices[t[(a + 1) % 3]])));
      return length;
    }

    SpaceVector
    place_of(const TriangleSurface &surface, const SurfacePoint &point)
    {
      SpaceVector place = nowhere;
      for (int a = 0; a < 3; ++a)
        place = plus(place, point.share[a], surface.vertices[surface.triangles[point.triangle][a]]);
      return place;
    }
  } // namespace

  bool
  faces_away(const TriangleSurface &surface, const unsigned int triangle, const SpaceVector &normal)
  {
    return dot(normal, triangle_normal(surface, triangle)) < -.25;
  }

  std::vector<std::optional<SurfacePoint>>
  facing_points(const TriangleSurface                  &surface,
                const std::vector<SurfaceMesh::Vertex> &points,
                const std::vector<SpaceVector>         &normals,
                const std::vector<SurfacePoint>        &nearest)
  {
    std::map<GridDirection, std::vector<std::size_t>> by_direction;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (faces_away(surface, nearest[i].triangle, normals[i]))
        by_direction[grid_direction(normals[i])].push_back(i);
    by_direction.erase(GridDirection{ { 0, 0, 0 } });

    std::vector<std::optional<SurfacePoint>> found(points.size());
    for (const auto &[direction, which] : by_direction)
    {
      const PartOfSurface part = facing(surface, direction);
      if (part.number.empty())
        continue;
      std::vector<SurfaceMesh::Vertex> places;
      for (const std::size_t i : which)
        places.push_back(points[i]);
      const auto on_part = closest_points(part.surface, places);
      for (std::size_t k = 0; k < places.size(); ++k)
      {
        const double distance = norm(minus(place_of(part.surface, on_part[k]), places[k]));
        if (distance <= longest_edge(part.surface, on_part[k].triangle))
          found[which[k]] = { part.number[on_part[k].triangle], on_part[k].share };
      }
    }
    return found;
  }
} // namespace Exemplar
