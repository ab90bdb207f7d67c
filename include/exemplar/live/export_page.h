// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_export_page_h
#define exemplar_live_export_page_h

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// A page that plays the frames of runs, side by side.
  struct RunPage
  {
    std::string html;
    std::size_t n_frames = 0;
    double      error    = 0.; ///< largest error of a coordinate [m]
  };

  /// A page that needs no other file: the surfaces in motion, and plots of statistics.csv. Throws
  /// UserError for a directory that is not that of a finished run with frames in the format vtu.
  RunPage
  page_of_runs(const std::vector<std::string> &directories);

  /// Write page_of_runs() to a file. Throws UserError, with nothing written, where page_of_runs()
  /// does, and for an existing file that is no such page.
  RunPage
  export_page(const std::vector<std::string> &directories, const std::filesystem::path &file);
} // namespace Exemplar::Live

#endif
