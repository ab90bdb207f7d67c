// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_text_h
#define exemplar_geo_text_h

#include <exemplar/mesh/geo_tokens.h>

#include <filesystem>
#include <map>

namespace Exemplar
{
  /// What gmsh is given to read instead of a .geo and all that it takes in.
  struct GeoText
  {
    std::string            script; ///< written from tokens, without comments and inclusions
    std::vector<GeoOrigin> origins; ///< of the script's lines
    /// Bytes of the files that the script merges, by the names that it has for them.
    std::map<std::string, std::string> data;

    /// SHA-256 of all of it.
    std::string
    digest() const;

    /// Lines of the script in gmsh's messages, which call it by its path, become those of the
    /// files that they come from.
    std::string
    with_origins(const std::string &messages, const std::string &path) const;
  };

  /// Read a .geo and all that it includes or merges, each file once. Names are relative to the
  /// file that they stand in. A merged file is data if its bytes are those of a format that gmsh
  /// reads (.stl, .step, .iges, .brep, .msh, .mesh, .ply, .vtk, .unv, .wrl, .pos), whatever its
  /// name; any other is a script, and part of the text. Options that gmsh takes unasked, of a file
  /// with .opt behind the name, are part of it, too. Throws UserError for a file that cannot be
  /// read or includes itself, an inclusion whose name is not a plain text in quotes, and for what
  /// check_geo() refuses.
  GeoText
  make_geo_text(const std::filesystem::path &geo);
} // namespace Exemplar

#endif
