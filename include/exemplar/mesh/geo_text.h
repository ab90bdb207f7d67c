// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_text_h
#define exemplar_geo_text_h

#include <exemplar/mesh/geo_script.h>

#include <filesystem>
#include <map>
#include <string>

namespace Exemplar
{
  /// The extension by which gmsh reads these bytes as data: .stl, .step, .iges, .brep, .msh,
  /// .mesh, .ply, .vtk, .unv, .wrl or .pos. Empty if they are not known to be in any such format.
  std::string
  merged_format(const std::string &bytes);

  /// The input of gmsh that replaces a .geo and all files that it takes in.
  struct GeoText
  {
    std::string            script;  ///< written from tokens, without comments and inclusions
    std::vector<GeoOrigin> origins; ///< origins of the script's lines
    /// Bytes of the files that the script merges, by the names that it has for them.
    std::map<std::string, std::string> data;

    /// SHA-256 of script and data.
    std::string
    digest() const;

    /// gmsh's messages, with lines of the script, which they call by its path, replaced by those of
    /// the files that they come from.
    std::string
    with_origins(const std::string &messages, const std::string &path) const;
  };

  /// Read a .geo and all that it includes or merges, each file once. Names are relative to the file
  /// that contains them. A merged file is data if its bytes are those of a format that gmsh reads
  /// (.stl, .step, .iges, .brep, .msh, .mesh, .ply, .vtk, .unv, .wrl, .pos), whatever its name; any
  /// other is a script, and part of the text. Options that gmsh reads by itself, from a file with
  /// .opt appended to the name, are part of it, too. Throws UserError for a file that cannot be
  /// read or includes itself, an inclusion whose name is not a plain text in quotes, and for a
  /// script that check_geo() refuses.
  GeoText
  make_geo_text(const std::filesystem::path &geo);
} // namespace Exemplar

#endif
