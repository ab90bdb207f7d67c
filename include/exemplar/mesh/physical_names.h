// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_physical_names_h
#define exemplar_physical_names_h

#include <exemplar/mesh/msh_file.h>

#include <optional>
#include <string>

namespace Exemplar
{
  /// Parse the designation of a group of elements: "17" is its id, "left" and "\"left wall\"" its
  /// name. Returns the id, if it is one. Throws UserError, with `key` in front, for an empty text
  /// or too large a number.
  std::optional<unsigned int>
  parse_id(const std::string &text, const std::string &key);

  /// The id in a mesh file of the group of a dimension (2: boundaries, 3: regions) designated by
  /// `text`, an id or a name of $PhysicalNames. Throws UserError, with `key` in front, if no group
  /// of the file has the name, or several have. An id need not exist.
  unsigned int
  find_id(const MshFile &mesh, int dimension, const std::string &text, const std::string &key);

  /// A reason, after a blank, why the mesh of a .geo may lack a group that its text has; empty for
  /// other meshes.
  std::string
  remedy_of_geo(const MshFile &mesh);
} // namespace Exemplar

#endif
