// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_physical_names_h
#define exemplar_physical_names_h

#include <exemplar/mesh/msh_file.h>

#include <optional>
#include <string>

namespace Exemplar
{
  /// What a group of elements is called by: "17" is its id, "left" and "\"left wall\"" its name.
  /// Returns the id, if it is one. Throws UserError, with `key` in front, for none or too large a
  /// number.
  std::optional<unsigned int>
  parse_id(const std::string &text, const std::string &key);

  /// The id that a mesh file gives to the group of a dimension (2: boundaries, 3: regions) that is
  /// called by `text`, an id or a name of $PhysicalNames. Throws UserError, with `key` in front, if
  /// no group of the file has the name, or several have. An id need not be there.
  unsigned int
  find_id(const MshFile &mesh, int dimension, const std::string &text, const std::string &key);

  /// Why the mesh of a .geo may lack a group that its text has, with a blank before it; empty for other
  /// meshes.
  std::string
  remedy_of_geo(const MshFile &mesh);
} // namespace Exemplar

#endif
