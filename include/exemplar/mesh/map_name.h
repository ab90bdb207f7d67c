// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_map_name_h
#define exemplar_map_name_h

#include <string>

namespace Exemplar
{
  /// A painted map in a scene: "FILE.ply:ATTRIBUTE" or "FILE.csv[:COLUMN]", followed by the use of
  /// its values, such as "above 0.5".
  struct MapName
  {
    std::string file;      ///< ends in .ply or .csv
    std::string attribute; ///< empty: not given
    std::string rest;      ///< the words that follow

    /// File and attribute, the key of the values.
    std::string
    name() const;
  };

  /// Parse a text. Throws UserError, calling it `key`, if it names no such file.
  MapName
  split_map_name(const std::string &text, const std::string &key);
} // namespace Exemplar

#endif
