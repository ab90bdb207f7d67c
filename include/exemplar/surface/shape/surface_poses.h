// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_poses_h
#define exemplar_surface_poses_h

#include <exemplar/surface/shape/surface_mesh.h>

#include <string>

// Checks of surfaces that are to be poses of another one, with the same vertices in the same order.
// All throw UserError and call surfaces by the names that are handed in.

namespace Exemplar
{
  /// Refuses coordinates that are not finite, and surfaces without area.
  void
  require_surface(const SurfaceMesh &surface, const std::string &name);

  /// Refuses another number of vertices or faces, and other corners of a face, with the first
  /// difference.
  void
  check_same_order(const SurfaceMesh &rest,
                   const std::string &rest_name,
                   const SurfaceMesh &pose,
                   const std::string &pose_name);

  /// Refuses a pose of another unit, a mirror image and a pose turned inside out.
  void
  check_pose(const SurfaceMesh &rest,
             const std::string &rest_name,
             const SurfaceMesh &pose,
             const std::string &pose_name);

  /// The axis x, y or z about which a pose is turned by a right angle (to 8 degrees) against the
  /// surface at rest, as a pose with another axis upwards is; else empty.
  std::string
  axis_of_right_angle(const SurfaceMesh &rest, const SurfaceMesh &pose);

  /// Whether all vertices of a pose lie where they lie at rest, to 1e-9 of the size.
  bool
  is_at_rest(const SurfaceMesh &rest, const SurfaceMesh &pose);
} // namespace Exemplar

#endif
