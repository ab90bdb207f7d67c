// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_command_h
#define exemplar_mesh_command_h

#include <exemplar/surface/filling/surface_meshing.h>

namespace Exemplar
{
  /// What the command line says of a mesh to be made.
  struct MeshCommandOptions
  {
    SurfaceMeshingOptions meshing;
    std::filesystem::path output; ///< .msh; the table goes beside it, .csv
    bool                  quiet = false;
    std::filesystem::path faults; ///< .csv; if it is given, they are listed and no mesh is made
  };

  /// Make a mesh inside a surface, write it and its table, and print the table. Nothing is written
  /// if anything fails. Throws UserError, SolverFailure as mesh_surface() does.
  /// Or write a table of the surface's faults, if `faults` is given.
  void
  run_mesh_command(const MeshCommandOptions &options);
} // namespace Exemplar

#endif
