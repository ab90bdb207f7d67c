// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/kernels/polar_decomposition.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/skin/facing_points.h>
#include <exemplar/surface/skin/surface_attachment.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    using Points   = SurfaceAttachment::Points;
    using Vertices = SurfaceAttachment::Vertices;
    using Offset   = dealii::Tensor<1, 3>;

    /// Greatest and mean distance of boundary nodes from the surface at rest that are accepted,
    /// over the size of the body.
    constexpr double max_distance = 0.1, mean_distance = 0.02;

    dealii::Point<3>
    point(const SurfaceMesh::Vertex &x)
    {
      return { x[0], x[1], x[2] };
    }

    using TriangleCorners = std::array<dealii::Point<3>, 3>;

    TriangleCorners
    corners(const std::array<unsigned int, 3> &triangle, const Vertices &vertices)
    {
      return { { point(vertices[triangle[0]]), point(vertices[triangle[1]]),
                 point(vertices[triangle[2]]) } };
    }

    Offset
    area_vector(const TriangleCorners &x)
    {
      return 0.5 * dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]);
    }

    void
    add_product(const Offset &a, const Offset &b, Matrix3<double> &sum)
    {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          sum[i][j] += a[i] * b[j];
    }

    /// The rotation that best takes a triangle's edges and normal from one place to another.
    Matrix3<double>
    turn(const TriangleCorners &from, const TriangleCorners &to)
    {
      Matrix3<double> B{};
      for (int a = 0; a < 3; ++a)
        add_product(to[(a + 1) % 3] - to[a], from[(a + 1) % 3] - from[a], B);
      const Offset normal = area_vector(from), turned = area_vector(to);
      const double size = std::sqrt(normal.norm() * turned.norm());
      if (size > 0.)
        add_product(turned, normal / size, B); // normal, weighted as an edge
      return closest_rotation(B);
    }

    /// Replaces nearest points on a part that faces the other way by points on the part which faces
    /// as the body does there.
    void
    prefer_facing(const TriangleSurface          &surface,
                  const Vertices                 &places,
                  const std::vector<SpaceVector> &normals,
                  std::vector<SurfacePoint>      &nearest)
    {
      std::size_t n_away = 0;
      for (std::size_t k = 0; k < places.size(); ++k)
        n_away += faces_away(surface, nearest[k].triangle, normals[k]) ? 1 : 0;
      if (2 * n_away > places.size())
        return; // the surface is inside out
      const auto facing = facing_points(surface, places, normals, nearest);
      for (std::size_t k = 0; k < places.size(); ++k)
        nearest[k] = facing[k].value_or(nearest[k]);
    }
  } // namespace

  SurfaceAttachment::SurfaceAttachment(const Points                    &all_nodes,
                                       const std::vector<BoundaryFace> &faces,
                                       TriangleSurface                  surface)
      : rest(std::move(surface))
  {
    struct Share
    {
      double area = 0.;
      Offset normal;
    };
    std::map<unsigned int, Share> share_of;
    for (const BoundaryFace &face : faces)
    {
      const Offset area = area_vector(
          { { all_nodes[face.nodes[0]], all_nodes[face.nodes[1]], all_nodes[face.nodes[2]] } });
      for (const unsigned int node : face.nodes)
      {
        share_of[node].area += area.norm() / 3.;
        share_of[node].normal += area;
      }
    }
    std::vector<SpaceVector> normals;
    for (const auto &[node, share] : share_of)
    {
      nodes.push_back(node);
      areas.push_back(share.area);
      const Offset normal = share.normal / std::max(share.normal.norm(), 1e-300);
      normals.push_back({ { normal[0], normal[1], normal[2] } });
    }
    hang(all_nodes, normals);
  }

  SurfaceAttachment::SurfaceAttachment(const Points             &all_nodes,
                                       std::vector<unsigned int> which,
                                       TriangleSurface           surface)
      : nodes(std::move(which)), areas(nodes.size(), 0.), rest(std::move(surface))
  {
    hang(all_nodes, {});
  }

  SurfaceAttachment::SurfaceAttachment(std::vector<unsigned int> which, TriangleSurface surface)
      : nodes(std::move(which)), areas(nodes.size(), 0.), distances(nodes.size(), 0.),
        rest(std::move(surface)), offsets(nodes.size())
  {
    std::vector<SurfacePoint> of_vertices(rest.vertices.size());
    for (unsigned int t = 0; t < rest.triangles.size(); ++t)
      for (unsigned int a = 0; a < 3; ++a)
      {
        SurfacePoint &point = of_vertices[rest.triangles[t][a]];
        point               = {};
        point.triangle      = t;
        point.share[a]      = 1.;
      }
    for (const unsigned int node : nodes)
      points.push_back(of_vertices[node]);
  }

  void
  SurfaceAttachment::hang(const Points &all_nodes, const std::vector<SpaceVector> &normals)
  {
    Vertices places;
    for (const unsigned int node : nodes)
    {
      const auto &x = all_nodes[node];
      places.push_back({ { x[0], x[1], x[2] } });
    }
    points = closest_points(rest, places);
    if (!normals.empty())
      prefer_facing(rest, places, normals, points);
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      offsets.push_back(all_nodes[nodes[k]] - place(points[k], rest.vertices));
      distances.push_back(offsets.back().norm());
    }
  }

  dealii::Point<3>
  SurfaceAttachment::place(const SurfacePoint &on_surface, const Vertices &vertices) const
  {
    const TriangleCorners x = corners(rest.triangles[on_surface.triangle], vertices);
    dealii::Point<3>      result;
    for (int a = 0; a < 3; ++a)
      result += on_surface.share[a] * x[a];
    return result;
  }

  Points
  SurfaceAttachment::targets(const Vertices &vertices) const
  {
    Points result;
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      const auto           &triangle = rest.triangles[points[k].triangle];
      const Matrix3<double> R = turn(corners(triangle, rest.vertices), corners(triangle, vertices));
      dealii::Point<3>      x = place(points[k], vertices);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          x[i] += R[i][j] * offsets[k][j];
      result.push_back(x);
    }
    return result;
  }

  void
  check_attachment(const SurfaceAttachment &attachment,
                   const Mesh              &mesh,
                   const std::string       &surface_name)
  {
    const auto  &distances = attachment.get_distances();
    const auto   farthest  = std::max_element(distances.begin(), distances.end());
    const double mean = std::accumulate(distances.begin(), distances.end(), 0.) / distances.size();
    const double size = mesh.diameter();
    if (*farthest < max_distance * size && mean < mean_distance * size)
      return;
    constexpr double other_unit = 8.; // a body is as large as its surface
    if (const double ratio = diagonal_of(attachment.get_surface().vertices) / size;
        ratio > other_unit || ratio < 1. / other_unit)
      throw UserError(mesh.get_name() + " is no mesh of the inside of " + surface_name
                      + ": the surface is " + short_text(ratio)
                      + " times as large. Give both in the same unit of length.");
    const unsigned int node = attachment.get_nodes()[farthest - distances.begin()];
    throw UserError(
        fmt::format("{} is no mesh of the inside of {}: node {} of its boundary is farthest from "
                    "the surface, by {} % of the body's size, the mean is {} %. Unit, axes and "
                    "place must be the same: make the mesh of this surface, by exemplar mesh.",
                    mesh.get_name(), surface_name, mesh.get_contents().node_numbers[node],
                    short_text(100. * *farthest / size), short_text(100. * mean / size)));
  }
} // namespace Exemplar
