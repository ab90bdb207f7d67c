// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_output_directory_h
#define exemplar_output_directory_h

#include <filesystem>
#include <string>
#include <vector>

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

  /// A file to be written, and how the program knows one that it has written itself.
  struct OwnFile
  {
    std::filesystem::path path;
    std::string           beginning;
    std::string           end = ""; ///< if the file is whole
  };

  /// Throws UserError if a file that this program has not written is in the way of one to be written or
  /// of its temporary, or if it is one of `inputs`.
  void
  require_replaceable(const OwnFile                            &file,
                      const std::vector<std::filesystem::path> &inputs,
                      const std::string                        &remedy);

  /// Whether a file begins with this line, by which a directory is known as ours.
  bool
  begins_with(const std::filesystem::path &file, const std::string &line);

  /// Whether nothing has this name, not even a link that leads nowhere.
  bool
  is_absent(const std::filesystem::path &file);

  /// Why a file is none that we have written, in words that follow "which": it is a directory, a
  /// link or protected, or does not begin as all that we write under its name does. Empty: it may be
  /// ours. A file that ends too early may be: it was written when the machine failed.
  std::string
  objection_to(const std::filesystem::path &file, const std::string &beginning);
} // namespace Exemplar

#endif
