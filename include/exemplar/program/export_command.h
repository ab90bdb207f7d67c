// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_export_command_h
#define exemplar_export_command_h

#include <string>
#include <vector>

namespace Exemplar
{
  /// Options of `exemplar export`.
  struct PageOptions
  {
    std::vector<std::string> runs; ///< output directories
    std::string              html; ///< file of the page
  };

  /// Write a page that plays the frames of runs, and print its accuracy. Throws UserError with
  /// nothing written.
  void
  write_page(const PageOptions &options);
} // namespace Exemplar

#endif
