// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_map_name_h
#define exemplar_map_name_h

#include <string>

namespace Exemplar
{
  /// What a scene says of a painted map: "FILE.ply:ATTRIBUTE" or "FILE.csv[:COLUMN]", and what is
  /// to be done with its values, such as "above 0.5".
  struct MapName
  {
    std::string file;      ///< ends in .ply or .csv
    std::string attribute; ///< empty: none is named
    std::string rest;      ///< the words behind it

    /// File and attribute, by which the values are known.
    std::string
    name() const;
  };

  /// Take a text apart. Throws UserError, calling it `key`, if it names no such file.
  MapName
  split_map_name(const std::string &text, const std::string &key);
} // namespace Exemplar

#endif
