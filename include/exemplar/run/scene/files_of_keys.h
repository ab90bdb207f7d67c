// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_files_of_keys_h
#define exemplar_files_of_keys_h

#include <exemplar/prm/key_table.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The names of input files, or patterns of names, in the value of a key: of poses and maps, of
  /// selections, of caches and paths of motions.
  std::vector<std::string>
  file_names(const DeclaredKey &key);

  /// The files that match one of file_names(), or the name itself if none exists.
  std::vector<std::filesystem::path>
  files_of_name(const DeclaredKey &key, const std::string &name);

  /// Append the input files that the value of a key names, existing or not; see file_names().
  void
  append_files(const DeclaredKey &key, std::vector<std::filesystem::path> &files);
} // namespace Exemplar

#endif
