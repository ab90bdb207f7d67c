// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_missing_file_h
#define exemplar_missing_file_h

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// Advice on the name of a file that cannot be opened: quotes, ~, a pattern, several names in
  /// one, a missing directory, a place beside the scene instead of the working directory, or a name
  /// close to that of a file beside, other than that of `not_meant`. One sentence that begins with
  /// a blank; empty for existing files.
  std::string
  missing_file_remedy(const std::filesystem::path &file,
                      const std::filesystem::path &not_meant = {});

  /// Throws UserError for a missing file, a directory, or a device. The file should be `what`, and
  /// is not `not_meant`.
  void
  require_file(const std::filesystem::path &file,
               const std::string           &what,
               const std::filesystem::path &not_meant = {});
} // namespace Exemplar

#endif
