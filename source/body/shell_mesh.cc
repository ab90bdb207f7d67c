// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/shell_mesh.h>
#include <exemplar/kernels/hinge_angle.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Exemplar
{
  namespace
  {
    using EdgeEnds = std::pair<unsigned int, unsigned int>;

    EdgeEnds
    ends_of(const ShellTriangle &triangle, const unsigned int i)
    {
      return std::minmax(triangle.nodes[i], triangle.nodes[(i + 1) % 3]);
    }

    /// Find the area, the frame and what is made of them, for these places of the vertices.
    void
    find_frame(const std::array<Vector3<double>, 3> &x, ShellTriangle &triangle)
    {
      const HingeSide<double> side(x[0], x[1], x[2]);
      triangle.area = 0.5 * side.length * side.height;
      triangle.axes = { { side.e, times(-1., side.t), side.n } };
      std::array<std::array<double, 2>, 3> in_plane; // places
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j)
          in_plane[i][j] = dot(difference(x[i], x[0]), triangle.axes[j]);
      const double root = triangle.thickness / std::sqrt(12.);
      for (int i = 0; i < 3; ++i)
      {
        const auto  &a = in_plane[i], &b = in_plane[(i + 1) % 3];
        const double t[2]   = { b[1] - a[1], a[0] - b[0] }; // outward normal times length
        const double length = std::hypot(t[0], t[1]), factor = root / (length * triangle.area);
        triangle.gradients[(i + 2) % 3]
            = { { -t[0] / (2. * triangle.area), -t[1] / (2. * triangle.area) } };
        triangle.bending[i]
            = { { factor * t[0] * t[0], factor * t[1] * t[1], factor * t[0] * t[1] } };
      }
    }
  } // namespace

  ShellMesh::ShellMesh(const std::vector<Vector3<double>>             &vertices,
                       const std::vector<std::array<unsigned int, 3>> &triangles,
                       const std::vector<double>                      &thickness,
                       const ShellKind                                 kind)
      : of_kind(kind), vertices(vertices), all_triangles(triangles.size())
  {
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
      all_triangles[i].nodes     = triangles[i];
      all_triangles[i].thickness = thickness[i];
    }
    find_edges();
    find_rest_shape();
    if (kind == ShellKind::hinges)
      bend_by_hinges();
  }

  void
  ShellMesh::find_edges()
  {
    std::vector<EdgeEnds> ends;
    for (const ShellTriangle &triangle : all_triangles)
      for (unsigned int i = 0; i < 3; ++i)
        ends.push_back(ends_of(triangle, i));
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    all_edges.assign(ends.size(), ShellEdge());
    const auto attach = [&](const unsigned int t, const unsigned int i, const unsigned int side)
    {
      ShellTriangle &triangle = all_triangles[t];
      const auto     found    = std::lower_bound(ends.begin(), ends.end(), ends_of(triangle, i));
      triangle.edges[i]       = found - ends.begin();
      triangle.signs[i]       = side == 0 ? 1. : -1.;
      ShellEdge &edge         = all_edges[triangle.edges[i]];
      edge.triangles[side]    = t;
      edge.opposite[side]     = triangle.nodes[(i + 2) % 3];
      if (side == 0)
      {
        edge.begin = triangle.nodes[i];
        edge.end   = triangle.nodes[(i + 1) % 3];
      }
    };
    // triangles that have an edge in the direction of ascending numbers are its first ones; at a border others are
    const auto ascends = [&](const unsigned int t, const unsigned int i)
    { return all_triangles[t].nodes[i] < all_triangles[t].nodes[(i + 1) % 3]; };
    for (unsigned int t = 0; t < all_triangles.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
        if (ascends(t, i))
          attach(t, i, 0);
    for (unsigned int t = 0; t < all_triangles.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
        if (!ascends(t, i))
        {
          const auto found
              = std::lower_bound(ends.begin(), ends.end(), ends_of(all_triangles[t], i));
          attach(t, i, all_edges[found - ends.begin()].triangles[0] == ShellEdge::none ? 0 : 1);
        }
  }

  void
  ShellMesh::find_rest_shape()
  {
    for (ShellTriangle &triangle : all_triangles)
      find_frame({ { vertices[triangle.nodes[0]], vertices[triangle.nodes[1]],
                     vertices[triangle.nodes[2]] } },
                 triangle);
    for (ShellEdge &edge : all_edges)
    {
      const Vector3<double> a = vertices[edge.begin], b = vertices[edge.end];
      edge.length = norm(difference(b, a));
      edge.normal = all_triangles[edge.triangles[0]].axes[2];
      if (edge.is_border())
        continue;
      edge.angle = HingeAngle<double>(a, b, vertices[edge.opposite[0]], vertices[edge.opposite[1]])
                       .value();
      // turned by half of the angle, which is defined where the two normals are opposite, too
      const HingeSide<double> side(a, b, vertices[edge.opposite[0]]);
      edge.normal = combine(std::cos(0.5 * edge.angle), side.n, std::sin(0.5 * edge.angle), side.t);
    }
    for (ShellTriangle &triangle : all_triangles)
      for (int i = 0; i < 3; ++i)
        triangle.lengths[i] = all_edges[triangle.edges[i]].length;
  }

  void
  ShellMesh::bend_by_hinges()
  {
    for (ShellTriangle &triangle : all_triangles)
      for (int i = 0; i < 3; ++i)
      {
        const ShellEdge &edge = all_edges[triangle.edges[i]];
        double           area = 0.;
        for (const unsigned int other : edge.triangles)
          if (other != ShellEdge::none)
            area += all_triangles[other].area;
        triangle.bending[i]    = {};
        triangle.bending[i][i] = triangle.thickness / std::sqrt(12.) * edge.length / area;
      }
  }

  Vector3<double>
  ShellMesh::tip(const unsigned int edge) const
  {
    const ShellEdge      &of     = all_edges[edge];
    const Vector3<double> middle = combine(0.5, vertices[of.begin], 0.5, vertices[of.end]);
    return combine(1., middle, of.length, of.normal);
  }

  std::size_t
  ShellMesh::memory_consumption() const
  {
    return vertices.capacity() * sizeof(vertices[0])
           + all_triangles.capacity() * sizeof(ShellTriangle)
           + all_edges.capacity() * sizeof(ShellEdge);
  }
} // namespace Exemplar
