// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_surface_h
#define exemplar_body_surface_h

#include <exemplar/surface/shape/surface_checks.h>

namespace Exemplar
{
  /// A surface that bounds a body: closed, oriented outwards, without intersections.
  struct BodySurface
  {
    TriangleSurface          surface;  ///< without unused vertices
    TriangleSurface          original; ///< surface of the file, triangulated
    std::vector<std::string> group_names;
    std::vector<std::string> notes; ///< what was found and repaired, a line each
  };

  struct SurfaceMeshingOptions;

  /// Check a surface that was read from `options.surface`. With `repair`, faults are repaired, and
  /// if some remain, the surface is wrapped; the notes say what was done and how far the surface
  /// moved. Throws UserError with all faults and their places.
  BodySurface
  make_body_surface(const SurfaceMesh &read, const SurfaceMeshingOptions &options);
} // namespace Exemplar

#endif
