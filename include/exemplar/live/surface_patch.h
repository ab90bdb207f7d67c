// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_surface_patch_h
#define exemplar_live_surface_patch_h

#include <exemplar/live/surface_frames.h>

namespace Exemplar::Live
{
  /// A point of the surface.
  struct SurfacePoint
  {
    unsigned int          triangle;
    std::array<double, 3> shares; ///< of its corners
  };

  /// Where it is when the nodes of the mesh are at these places.
  dealii::Point<3>
  place_of(const SurfacePoint &point, const BodySurface &surface, const Vector &positions);

  /// What a hand takes hold of.
  struct SurfacePatch
  {
    std::vector<unsigned int> nodes;  ///< of the mesh, ascending
    std::vector<double>       shares; ///< of each; their sum is 1
  };

  /// All of the surface around a point that hangs together with its triangle within a radius [m], at these
  /// positions: (1 - (d/radius)^2)^2 at the distance d, times the area that a vertex stands for, so that
  /// the shares do not depend on how fine the surface is. A triangle that is larger than the radius is
  /// taken hold of at its three corners at least.
  SurfacePatch
  patch_around(const SurfacePoint &point,
               const BodySurface  &surface,
               const Vector       &positions,
               double              radius);
} // namespace Exemplar::Live

#endif
