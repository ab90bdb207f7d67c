// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_making_h
#define exemplar_mesh_making_h

#include <exemplar/surface/surface_meshing.h>

namespace Exemplar
{
  /// mesh_surface() in a process of its own, because CGAL and gmsh may crash or never end on odd
  /// surfaces, and gmsh keeps one model for the whole process. The mesh is written to `msh`, whole
  /// or not at all. Throws as mesh_surface() does, and SolverFailure for a crash and after 15 s
  /// and 30 ms a cell and 0.1 ms a byte of the surface.
  MeshingReport
  make_mesh_file(const SurfaceMeshingOptions &options, const std::filesystem::path &msh);

  /// The comment by which such a mesh is known.
  extern const std::string made_mesh_comment;

  /// A report as one line of text, and back. Throws std::exception for another text.
  std::string
  to_text(const MeshingReport &report);
  MeshingReport
  report_from_text(const std::string &text);
} // namespace Exemplar

#endif
