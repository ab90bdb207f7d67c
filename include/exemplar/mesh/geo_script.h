// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_script_h
#define exemplar_geo_script_h

#include <exemplar/mesh/geo_tokens.h>

// A .geo file is a program for gmsh: it may run others, and write files anywhere.

namespace Exemplar
{
  /// Throws UserError if a script, whose inclusions have been resolved, could run a program, write
  /// a file or read another one: for any word by which gmsh does that.
  void
  check_geo(const std::vector<GeoToken> &script);

  /// Whether the word at a place is a command, not a variable or an option of this name.
  bool
  is_geo_command(const std::vector<GeoToken> &script, std::size_t place);

  /// The token at a place; a sign of no text behind the end.
  const GeoToken &
  geo_token(const std::vector<GeoToken> &script, std::size_t place);
} // namespace Exemplar

#endif
