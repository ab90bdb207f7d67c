// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_numbered_files_h
#define exemplar_numbered_files_h

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Natural order of names, in which numbers count as numbers: walk_9 comes before walk_10.
  bool
  comes_before(const std::string &a, const std::string &b);

  /// The files of a sequence: each entry is a file, or a pattern whose file name has * (any
  /// characters) or ? (one character) and stands for the files that match it, ordered by
  /// comes_before(). Throws UserError for a pattern that no file matches.
  std::vector<std::filesystem::path>
  expand_patterns(const std::vector<std::string> &entries);
} // namespace Exemplar

#endif
