// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_parted_sheets_h
#define exemplar_parted_sheets_h

#include <exemplar/surface/filling/surface_meshing.h>

namespace Exemplar
{
  /// Whether sheets cross at the surface's own vertices.
  bool
  has_crossing_sheets(const SurfaceMesh &surface);

  /// mesh_surface() for a surface whose sheets may cross at rest, as lips do: it is filled where
  /// they are apart in `options.poses`, and the cells are carried back to rest, where they may then
  /// overlap. Crossings that no pose parts are treated as without poses, and a note says where they
  /// are. Without crossing sheets this is mesh_surface(). Throws as mesh_surface() and
  /// read_pose_surface() do.
  MeshedSurface
  mesh_parted(const SurfaceMeshingOptions &options);
} // namespace Exemplar

#endif
