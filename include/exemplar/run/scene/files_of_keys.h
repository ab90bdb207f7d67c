// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_files_of_keys_h
#define exemplar_files_of_keys_h

#include <exemplar/prm/key_table.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The texts in the value of a key that name its input files: of poses and maps, of selections, of what a
  /// motion follows. A pattern is one of them.
  std::vector<std::string>
  file_names(const DeclaredKey &key);

  /// The files that one of file_names() stands for, also if they are not there.
  std::vector<std::filesystem::path>
  files_of_name(const DeclaredKey &key, const std::string &name);

  /// Append the input files that the value of a key names, also those that are not there: of poses and
  /// maps, of selections, of what a motion follows.
  void
  append_files(const DeclaredKey &key, std::vector<std::filesystem::path> &files);
} // namespace Exemplar

#endif
