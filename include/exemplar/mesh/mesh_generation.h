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

  /// Mesh a .geo file with gmsh. Returns the .msh, which is kept in
  /// $XDG_CACHE_HOME/exemplar or ~/.cache/exemplar under the SHA-256 of the .geo's
  /// text and gmsh's version, and used again without meshing. Files that the .geo
  /// takes in (Include, Merge) are not part of that key: after changing one of
  /// them, change the .geo, too, or empty the cache.
  std::filesystem::path
  mesh_geo_file(const std::filesystem::path &geo);
} // namespace Exemplar

#endif
