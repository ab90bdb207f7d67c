// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_made_of_surfaces_h
#define exemplar_made_of_surfaces_h

#include <exemplar/surface/filling/surface_meshing.h>
#include <exemplar/surface/skin/pose_quality.h>

namespace Exemplar
{
  /// Report on inputs made of surfaces, for the user to judge.
  struct MadeOfSurfaces
  {
    /// A pose that was carried onto the mesh, and how well.
    struct Pose
    {
      std::string file;
      PoseQuality quality;
    };

    MeshingReport            mesh; ///< empty if the mesh was not made of a surface
    std::vector<Pose>        poses;
    std::vector<std::string> warnings; ///< of meshing and of carrying poses
  };

  /// The report for the user, a line each.
  std::vector<std::string>
  lines_of(const MadeOfSurfaces &made);

  /// Warnings of meshing and of carrying poses, and of poses that the mesh follows badly.
  std::vector<std::string>
  warnings_of(const MadeOfSurfaces &made);
} // namespace Exemplar

#endif
