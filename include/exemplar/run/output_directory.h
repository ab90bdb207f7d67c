// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_output_directory_h
#define exemplar_output_directory_h

#include <filesystem>
#include <string>

// What directories of results have in common, of runs and of studies. Messages end in
// `remedy`, which says how to choose another directory.

namespace Exemplar
{
  /// Throws UserError unless `path` is a directory, or may become one, in which may be written.
  void
  require_writable(const std::filesystem::path &path, const std::string &remedy);

  /// Throws UserError if that fails.
  void
  make_directory(const std::filesystem::path &path, const std::string &remedy);

  /// Whether a file begins with this line, by which a directory is known as ours.
  bool
  begins_with(const std::filesystem::path &file, const std::string &line);
} // namespace Exemplar

#endif
