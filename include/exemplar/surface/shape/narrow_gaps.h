// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_narrow_gaps_h
#define exemplar_narrow_gaps_h

#include <exemplar/surface/shape/closest_points.h>
#include <exemplar/surface/shape/vectors.h>

// Narrow gaps outside of a surface, between sheets that face each other, as lips do.

namespace Exemplar
{
  /// A gap, seen from the middle of a triangle along its normal.
  struct NarrowGap
  {
    SurfacePoint near, far; ///< its ends on the surface
    SpaceVector  middle;
  };

  /// The gaps narrower than `width`, at most one a triangle, by ascending triangles `near`.
  /// Triangles must face outwards.
  std::vector<NarrowGap>
  narrow_gaps(const TriangleSurface &surface, double width);

  /// Whether places are outside of a closed surface. Edges have two triangles each.
  std::vector<bool>
  are_outside(const TriangleSurface &surface, const std::vector<SpaceVector> &places);
} // namespace Exemplar

#endif
