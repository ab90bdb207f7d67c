// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_script_h
#define exemplar_geo_script_h

#include <filesystem>
#include <string>
#include <vector>

// A .geo file is a program for gmsh: it may run others, and write files anywhere.

namespace Exemplar
{
  /// A piece of a script: a word, the inside of a string, or a sign.
  struct GeoToken
  {
    enum class Kind
    {
      word,
      text,
      sign
    };

    Kind         kind;
    std::string  text;
    unsigned int line; ///< of the file, from 1
  };

  /// Take a script apart as gmsh does, without its comments; numbers are left out. `name` stands
  /// for it in messages. Throws UserError for what gmsh might read in another way than this does:
  /// strings that do not end on their line, are longer than gmsh's 1023 bytes or hold a word that
  /// ends a skipped part, and control characters.
  std::vector<GeoToken>
  tokens_of_geo(const std::string &text, const std::string &name);

  /// What the mesh of a script depends on.
  struct GeoInputs
  {
    std::string digests;          ///< SHA-256 of the script and of all that it includes or merges
    bool        all_known = true; ///< whether that is all: no script reads files by other words
  };

  /// Read a script and all that it includes or merges. Throws UserError if it cannot be read, and
  /// if it, or what it includes, could run a program or write a file: for any word by which gmsh
  /// does that, and for an inclusion whose name is not a plain text.
  GeoInputs
  check_geo(const std::filesystem::path &geo);
} // namespace Exemplar

#endif
