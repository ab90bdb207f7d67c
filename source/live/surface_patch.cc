// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/surface_patch.h>

#include <algorithm>
#include <cmath>

namespace Exemplar::Live
{
  namespace
  {
    /// Least ratio of the radius and the distance to the farthest corner of the triangle.
    constexpr double min_radius_over_corner = 1.5;

    dealii::Point<3>
    place_of_vertex(const unsigned int vertex, const BodySurface &surface, const Vector &positions)
    {
      const unsigned int dof = 3 * surface.nodes[vertex];
      return { positions[dof], positions[dof + 1], positions[dof + 2] };
    }

    /// The corners of a triangle and all vertices connected with them by edges to near vertices.
    std::vector<bool>
    reached(const unsigned int begin, const BodySurface &surface, const std::vector<bool> &is_near)
    {
      std::vector<bool> is_reached(surface.nodes.size());
      for (const unsigned int vertex : surface.triangles[begin])
        is_reached[vertex] = true;
      for (bool grows = true; grows;)
      {
        grows = false;
        for (const auto &triangle : surface.triangles)
          if (std::any_of(triangle.begin(), triangle.end(),
                          [&](const unsigned int vertex) { return is_reached[vertex]; }))
            for (const unsigned int vertex : triangle)
              if (is_near[vertex] && !is_reached[vertex])
                grows = is_reached[vertex] = true;
      }
      return is_reached;
    }

    /// The area of each vertex: a third of each triangle at it [m^2].
    std::vector<double>
    areas(const BodySurface &surface, const Vector &positions)
    {
      std::vector<double> areas(surface.nodes.size());
      for (const auto &triangle : surface.triangles)
      {
        const auto   a    = place_of_vertex(triangle[0], surface, positions);
        const auto   b    = place_of_vertex(triangle[1], surface, positions);
        const auto   c    = place_of_vertex(triangle[2], surface, positions);
        const double area = 0.5 * dealii::cross_product_3d(b - a, c - a).norm();
        for (const unsigned int vertex : triangle)
          areas[vertex] += area / 3.;
      }
      return areas;
    }
  } // namespace

  dealii::Point<3>
  place_of(const SurfacePoint &point, const BodySurface &surface, const Vector &positions)
  {
    dealii::Point<3> place;
    for (unsigned int a = 0; a < 3; ++a)
      place += point.shares[a]
               * dealii::Tensor<1, 3>(
                   place_of_vertex(surface.triangles[point.triangle][a], surface, positions));
    return place;
  }

  SurfacePatch
  patch_around(const SurfacePoint &point,
               const BodySurface  &surface,
               const Vector       &positions,
               double              radius)
  {
    const dealii::Point<3> center   = place_of(point, surface, positions);
    const auto             distance = [&](const unsigned int vertex)
    { return place_of_vertex(vertex, surface, positions).distance(center); };
    for (const unsigned int vertex : surface.triangles[point.triangle])
      radius = std::max(radius, min_radius_over_corner * distance(vertex));
    std::vector<bool> is_near;
    for (unsigned int vertex = 0; vertex < surface.nodes.size(); ++vertex)
      is_near.push_back(distance(vertex) < radius);

    const std::vector<bool>   is_reached = reached(point.triangle, surface, is_near);
    const std::vector<double> area       = areas(surface, positions);
    SurfacePatch              patch;
    double                    sum = 0.;
    for (unsigned int vertex = 0; vertex < surface.nodes.size(); ++vertex)
      if (is_reached[vertex])
      {
        const double d = distance(vertex) / radius;
        patch.nodes.push_back(surface.nodes[vertex]);
        patch.shares.push_back((1. - d * d) * (1. - d * d) * area[vertex]);
        sum += patch.shares.back();
      }
    for (double &share : patch.shares)
      share /= sum;
    return patch;
  }
} // namespace Exemplar::Live
