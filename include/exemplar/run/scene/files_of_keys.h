// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_files_of_keys_h
#define exemplar_files_of_keys_h

#include <exemplar/prm/key_table.h>

#include <filesystem>
#include <vector>

namespace Exemplar
{
  /// Append the input files that the value of a key names, also those that are not there: of poses and
  /// maps, of selections, of what a motion follows.
  void
  append_files(const DeclaredKey &key, std::vector<std::filesystem::path> &files);
} // namespace Exemplar

#endif
