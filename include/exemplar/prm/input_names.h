// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_input_names_h
#define exemplar_input_names_h

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// The name of an input file, or a list of names separated by commas, made absolute if
  /// `directory` is not empty. Throws UserError for a name that a scene file cannot hold.
  std::string
  absolute_files(const std::string &value, bool is_list, const std::filesystem::path &directory);
} // namespace Exemplar

#endif
