// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_triangle_surface_h
#define exemplar_triangle_surface_h

#include <exemplar/surface/shape/surface_mesh.h>

namespace Exemplar
{
  /// A triangle surface; where orientation is checked, triangles are counterclockwise seen from
  /// outside.
  struct TriangleSurface
  {
    using Vertex = SurfaceMesh::Vertex;

    std::vector<Vertex>                      vertices;
    std::vector<std::array<unsigned int, 3>> triangles; ///< vertices from 0
    std::vector<unsigned int> groups; ///< one a triangle: index of SurfaceMesh::group_names
  };

  /// The polygons of a surface cut into triangles; no vertex is moved or added. A polygon is cut at
  /// the ear with the largest smallest angle, again and again, as seen along its normal (Newell),
  /// so that polygons that are not convex keep their shape. The triangles of a polygon follow one
  /// another; `faces`, if given, gets the polygon of each triangle. Without groups all are of 0.
  TriangleSurface
  triangulate(const SurfaceMesh &surface, std::vector<unsigned int> *faces = nullptr);

  /// The volume that a closed surface encloses; negative if it is inside out.
  double
  enclosed_volume(const TriangleSurface &surface);

  /// The diagonal of the box around the vertices.
  double
  diagonal_of(const std::vector<SurfaceMesh::Vertex> &vertices);

  /// The area of a triangle.
  double
  area_of(const TriangleSurface &surface, std::size_t triangle);
} // namespace Exemplar

#endif
