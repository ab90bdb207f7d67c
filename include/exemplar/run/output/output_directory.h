// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_output_directory_h
#define exemplar_output_directory_h

#include <filesystem>
#include <string>
#include <vector>

// Checks that directories of runs and of studies share. Messages end in `remedy`, which says how to
// choose another directory.

namespace Exemplar
{
  /// Throws UserError unless `path` is, or can be made, a directory with permission to write.
  void
  require_writable(const std::filesystem::path &path, const std::string &remedy);

  /// Throws UserError if the directory cannot be made.
  void
  make_directory(const std::filesystem::path &path, const std::string &remedy);

  /// A file to be written, and how the program recognises its own.
  struct OwnFile
  {
    std::filesystem::path path;
    std::string           beginning;
    std::string           end = ""; ///< of a complete file
  };

  /// Throws UserError if this would overwrite a file, or temporary file, of another program, or one
  /// of `inputs`.
  void
  require_replaceable(const OwnFile                            &file,
                      const std::vector<std::filesystem::path> &inputs,
                      const std::string                        &remedy);

  /// Whether a file begins with this line, which marks directories of this program.
  bool
  begins_with(const std::filesystem::path &file, const std::string &line);

  /// Whether no file has this name, not even a dangling link.
  bool
  is_absent(const std::filesystem::path &file);

  /// Why a file cannot be one that this program has written, in words that follow "which": it is a
  /// directory, a link or protected, or does not begin like such files. Empty if it may be one. A
  /// truncated file may be, from a crash of the machine.
  std::string
  objection_to(const std::filesystem::path &file, const std::string &beginning);
} // namespace Exemplar

#endif
