// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_input_names_h
#define exemplar_input_names_h

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// The name of an input file, or names separated by commas if it is a list, made absolute if
  /// there is a directory to start from. Throws UserError for a name that a scene file could not
  /// hold.
  std::string
  absolute_files(const std::string &value, bool is_list, const std::filesystem::path &directory);
} // namespace Exemplar

#endif
