// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_painted_map_h
#define exemplar_painted_map_h

#include <exemplar/surface/shape/surface_mesh.h>

#include <map>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A value for each vertex of a surface, by the name of the map that gives them; NaN where a
  /// table lists no value.
  using NamedMaps = std::map<std::string, std::vector<double>>;

  /// The values that a file has for the vertices of a surface: a scalar property `attribute` of the
  /// vertices of a .ply (one byte wide ones over 255, as colours are), or a column of a .csv. A
  /// table has a column `vertex` with numbers from 1, or a row for each vertex in order; with one
  /// column of values `attribute` may be empty. Throws UserError for what cannot be read, for
  /// another number or order of vertices, and for values that are not finite, calling the surface
  /// by its name.
  std::vector<double>
  read_painted_map(const std::filesystem::path &file,
                   const std::string           &attribute,
                   const SurfaceMesh           &surface,
                   const std::string           &surface_name);
} // namespace Exemplar

#endif
