// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_closest_points_h
#define exemplar_closest_points_h

#include <exemplar/surface/shape/triangle_surface.h>

namespace Exemplar
{
  /// A point of a surface of triangles.
  struct SurfacePoint
  {
    unsigned int          triangle;
    std::array<double, 3> share; ///< barycentric coordinates: none negative, sum 1
  };

  /// The point nearest to each of `points` on a surface of which one triangle at least has an area;
  /// those without are passed over. Vertices must be finite.
  std::vector<SurfacePoint>
  closest_points(const TriangleSurface &surface, const std::vector<SurfaceMesh::Vertex> &points);
} // namespace Exemplar

#endif
