// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_generation_h
#define exemplar_mesh_generation_h

#include <exemplar/mesh/msh_file.h>

#include <array>
#include <filesystem>

namespace Exemplar
{
  /// The box of MeshParameters as if read from a file.
  MshFile
  generate_box(const std::array<double, 3> &size, const std::array<unsigned int, 3> &n_cells);

  /// Mesh a .geo file with gmsh, in an empty directory and not for ever. Returns the .msh, which
  /// is kept sealed in $XDG_CACHE_HOME/exemplar or ~/.cache/exemplar under the SHA-256 of all that
  /// it follows from (the .geo, what it includes or merges, and gmsh's version) and used again
  /// while its seal is whole; where the .geo reads other files, too, it is meshed each time.
  /// Throws UserError for a .geo that could run programs or write files, unless `allow_commands`.
  std::filesystem::path
  mesh_geo_file(const std::filesystem::path &geo, bool allow_commands);
} // namespace Exemplar

#endif
