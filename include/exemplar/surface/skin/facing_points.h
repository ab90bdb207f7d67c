// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_facing_points_h
#define exemplar_facing_points_h

#include <exemplar/surface/shape/closest_points.h>
#include <exemplar/surface/shape/vectors.h>

#include <optional>

// Nearest points of a surface on the part that faces the right way: where limbs touch and lips
// almost do, the nearest point may be of another part, which faces the other way.

namespace Exemplar
{
  /// Whether a triangle faces so much against a unit normal that it must be of another part.
  bool
  faces_away(const TriangleSurface &surface, unsigned int triangle, const SpaceVector &normal);

  /// Replacements of nearest points: for each of `points`, with its nearest point in `nearest`,
  /// nothing, unless its nearest triangle faces_away() from its normal. Then the point nearest to
  /// it on triangles that face the same way; nothing if that is farther than the triangle is long.
  std::vector<std::optional<SurfacePoint>>
  facing_points(const TriangleSurface                  &surface,
                const std::vector<SurfaceMesh::Vertex> &points,
                const std::vector<SpaceVector>         &normals,
                const std::vector<SurfacePoint>        &nearest);
} // namespace Exemplar

#endif
