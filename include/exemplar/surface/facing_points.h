// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_facing_points_h
#define exemplar_facing_points_h

#include <exemplar/surface/closest_points.h>
#include <exemplar/surface/vectors.h>

#include <optional>

// Where limbs touch and lips almost do, the nearest point of a surface may be of another part of it,
// which faces the other way.

namespace Exemplar
{
  /// Of a triangle, of length 1; 0 if it has no area.
  SpaceVector
  triangle_normal(const TriangleSurface &surface, unsigned int triangle);

  /// Whether a triangle faces so much against a normal of length 1 that it must be of another part.
  bool
  faces_away(const TriangleSurface &surface, unsigned int triangle, const SpaceVector &normal);

  /// The points nearest to each of `points` on triangles that face the same way as its normal, of
  /// length 1, does; nothing where that is farther than the triangle is long, or the normal is 0.
  std::vector<std::optional<SurfacePoint>>
  closest_facing_points(const TriangleSurface                  &surface,
                        const std::vector<SurfaceMesh::Vertex> &points,
                        const std::vector<SpaceVector>         &normals);
} // namespace Exemplar

#endif
