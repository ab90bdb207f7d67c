// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_fold_bodies_h
#define exemplar_tests_fold_bodies_h

#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/shape/closest_points.h>

#include <functional>
#include <vector>

// Small bodies with their surfaces, and what is done to them.
namespace Exemplar::Testing
{
  using Points = std::vector<dealii::Point<3>>;

  /// [0, 4] x [-1/2, 1/2]^2.
  inline Mesh
  small_bar(const unsigned int n_across = 2)
  {
    MeshParameters parameters;
    parameters.generator = MeshGenerator::box;
    parameters.box_size  = { { 4., 1., 1. } };
    parameters.box_cells = { { 4 * n_across, n_across, n_across } };
    return Mesh(parameters);
  }

  inline std::vector<SurfaceMesh::Vertex>
  vertices(const Points &points)
  {
    std::vector<SurfaceMesh::Vertex> result;
    for (const auto &x : points)
      result.push_back({ { x[0], x[1], x[2] } });
    return result;
  }

  /// The boundary of a mesh, with its nodes at these places.
  inline TriangleSurface
  boundary_of(const Mesh &mesh, const Points &points)
  {
    TriangleSurface surface;
    surface.vertices = vertices(points);
    for (const BoundaryFace &face : mesh.get_boundary_faces())
      surface.triangles.push_back(face.nodes);
    return surface;
  }

  /// The same with polygons.
  inline SurfaceMesh
  boundary_as_surface(const Mesh &mesh)
  {
    SurfaceMesh surface;
    surface.vertices = vertices(mesh.get_nodes());
    for (const BoundaryFace &face : mesh.get_boundary_faces())
      surface.faces.push_back({ face.nodes.begin(), face.nodes.end() });
    return surface;
  }

  inline Points
  mapped(Points points, const std::function<dealii::Point<3>(const dealii::Point<3> &)> &map)
  {
    for (auto &x : points)
      x = map(x);
    return points;
  }

  /// The bar's axis as a circle, from x on up; the whole bar turns by `angle`.
  inline Points
  bent(const Points &points, const double angle)
  {
    const double radius = 4. / angle;
    return mapped(points,
                  [radius](const dealii::Point<3> &x)
                  {
                    const double r = radius - x[2], a = x[0] / radius;
                    return dealii::Point<3>(r * std::sin(a), x[1], radius - r * std::cos(a));
                  });
  }

  inline double
  max_distance_between(const Points &a, const Points &b)
  {
    double maximum = 0.;
    for (std::size_t i = 0; i < a.size(); ++i)
      maximum = std::max(maximum, a[i].distance(b[i]));
    return maximum;
  }
} // namespace Exemplar::Testing

#endif
