// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_making_h
#define exemplar_mesh_making_h

#include <exemplar/surface/filling/surface_meshing.h>

namespace Exemplar
{
  /// mesh_surface() in a confined process of its own (see confine_this_process()), because CGAL and
  /// gmsh may crash or never end on odd surfaces, and gmsh keeps one model for the whole process.
  /// Returns the bytes of a .msh with the report as its comment. Throws as mesh_surface() does, and
  /// SolverFailure for a crash and after 60 s and 30 ms a cell and 0.1 ms a byte of the surface.
  std::string
  make_mesh(const SurfaceMeshingOptions &options);

  /// The same, written to `msh` without the comment, whole or not at all.
  MeshingReport
  make_mesh_file(const SurfaceMeshingOptions &options, const std::filesystem::path &msh);

  /// The comment by which the file is known.
  extern const std::string made_mesh_comment;

  /// The report in what make_mesh() has returned. Throws std::exception if there is none.
  MeshingReport
  report_in(const std::string &msh);
} // namespace Exemplar

#endif
