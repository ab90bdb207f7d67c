// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_parted_sheets_h
#define exemplar_parted_sheets_h

#include <exemplar/surface/filling/surface_meshing.h>

namespace Exemplar
{
  /// mesh_surface() of a surface whose sheets may cross at rest, as lips do: it is filled where they
  /// are apart in `options.poses`, and the cells follow it back to rest, where they overlap then. What
  /// no pose parts is treated as without poses, and a note says where it is. Without crossing sheets
  /// the same as mesh_surface(). Throws as that, and as read_pose_surface().
  MeshedSurface
  mesh_parted(const SurfaceMeshingOptions &options);
} // namespace Exemplar

#endif
