// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_export_command_h
#define exemplar_export_command_h

#include <string>
#include <vector>

namespace Exemplar
{
  /// What `exemplar export` is told.
  struct PageOptions
  {
    std::vector<std::string> runs; ///< output directories
    std::string              html; ///< the page
  };

  /// Write one page that plays the frames of runs, and say how exact it is. Throws UserError with nothing
  /// written.
  void
  write_page(const PageOptions &options);
} // namespace Exemplar

#endif
