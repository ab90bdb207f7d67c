// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_surface_patch_h
#define exemplar_live_surface_patch_h

#include <exemplar/live/surface_frames.h>

namespace Exemplar::Live
{
  /// A point of the surface in barycentric coordinates.
  struct SurfacePoint
  {
    unsigned int          triangle;
    std::array<double, 3> shares; ///< one for each corner
  };

  /// Place of a surface point for these positions of the nodes.
  dealii::Point<3>
  place_of(const SurfacePoint &point, const BodySurface &surface, const Vector &positions);

  /// Weighted nodes that a hand takes hold of.
  struct SurfacePatch
  {
    std::vector<unsigned int> nodes;  ///< nodes of the mesh, ascending
    std::vector<double>       shares; ///< weight of each node; sum 1
  };

  /// The patch around a point: the part of the surface connected with its triangle within a radius
  /// [m], at these positions. The weight is (1 - (d/radius)^2)^2 at the distance d, times the area
  /// of a vertex, so that it does not depend on how fine the surface is. A triangle larger than the
  /// radius is taken hold of at its three corners at least.
  SurfacePatch
  patch_around(const SurfacePoint &point,
               const BodySurface  &surface,
               const Vector       &positions,
               double              radius);
} // namespace Exemplar::Live

#endif
