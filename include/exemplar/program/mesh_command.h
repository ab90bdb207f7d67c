// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_command_h
#define exemplar_mesh_command_h

#include <exemplar/surface/filling/surface_meshing.h>

namespace Exemplar
{
  /// Options of `exemplar mesh`.
  struct MeshCommandOptions
  {
    SurfaceMeshingOptions meshing;
    std::filesystem::path output; ///< .msh; the table .csv is written next to it
    bool                  quiet = false;
    std::filesystem::path faults; ///< .csv; if given, faults are listed and no mesh is made
  };

  /// Make a mesh inside a surface, write it and its table, and print the table; or, if `faults` is
  /// given, write a table of the surface's faults. Nothing is written if anything fails. Throws
  /// UserError, and SolverFailure as mesh_surface().
  void
  run_mesh_command(const MeshCommandOptions &options);
} // namespace Exemplar

#endif
