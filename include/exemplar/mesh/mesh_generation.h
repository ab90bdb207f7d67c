// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_generation_h
#define exemplar_mesh_generation_h

#include <exemplar/mesh/msh_file.h>

#include <array>
#include <filesystem>

namespace Exemplar
{
  /// The box of MeshParameters in the form of a file.
  MshFile
  generate_box(const std::array<double, 3> &size, const std::array<unsigned int, 3> &n_cells);

  /// Mesh a .geo file by gmsh, in a confined copy of this process with limits. gmsh reads the text
  /// of make_geo_text(); the mesh is cached (see kept_bytes()) under the SHA-256 of that text and
  /// of the mesher's identity. With `allow_commands` gmsh reads the file itself, may run programs
  /// and write files, and does so each time. Throws UserError for a .geo that could do that without
  /// being allowed, or that gmsh cannot mesh.
  MshFile
  mesh_geo_file(const std::filesystem::path &geo, bool allow_commands);
} // namespace Exemplar

#endif
