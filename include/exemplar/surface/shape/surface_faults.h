// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_faults_h
#define exemplar_surface_faults_h

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// The first line of table_of_faults().
  inline const char *const header_of_faults = "fault,element,number,index,x,y,z\n";

  /// Check a surface, in a process of its own, and return all faults that make it unfit to be
  /// filled, as a table in CSV: a row for each face or vertex of a fault, with its number in the
  /// file from 1 and from 0, and its place in the file's unit. Throws UserError for a file that is
  /// no surface.
  std::string
  table_of_faults(const std::filesystem::path &surface);
} // namespace Exemplar

#endif
