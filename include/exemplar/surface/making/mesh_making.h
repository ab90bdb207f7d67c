// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_making_h
#define exemplar_mesh_making_h

#include <exemplar/surface/filling/surface_meshing.h>

namespace Exemplar
{
  /// The stage that mesh generation has reached, and the attempt at it, from 1. With this alignment
  /// every compiler writes it atomically, for another process to read.
  struct alignas(8) MeshingPoint
  {
    MeshingStage   stage   = MeshingStage::checking;
    unsigned short attempt = 1;
  };

  using ShowMeshing = std::function<void(MeshingPoint)>;

  /// mesh_surface() in a confined process of its own (see confine_this_process()), because CGAL and
  /// gmsh may crash or never end on odd surfaces, and gmsh keeps one model for the whole process.
  /// Returns the bytes of a .msh with the report as its comment. Throws as mesh_surface() does, and
  /// SolverFailure for a crash and after 60 s and 30 ms a cell and 0.1 ms a byte of the surface.
  /// `show` is called here, several times a second, with what it has come to.
  std::string
  make_mesh(const SurfaceMeshingOptions &options, const ShowMeshing &show = {});

  /// make_mesh(), written to the file `msh` without the comment, whole or not at all.
  MeshingReport
  make_mesh_file(const SurfaceMeshingOptions &options,
                 const std::filesystem::path &msh,
                 const ShowMeshing           &show = {});

  /// The comment by which files of make_mesh_file() are known.
  extern const std::string made_mesh_comment;

  /// The report in the bytes that make_mesh() returned. Throws std::exception if there is none.
  MeshingReport
  report_in(const std::string &msh);
} // namespace Exemplar

#endif
