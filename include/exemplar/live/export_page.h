// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_export_page_h
#define exemplar_live_export_page_h

#include <filesystem>
#include <string>

namespace Exemplar::Live
{
  /// What was written.
  struct ExportedPage
  {
    std::size_t n_frames, n_bytes;
    double      error; ///< how far a coordinate is from the run's, at most [m]
  };

  /// Write the frames of a finished run as one page that needs no other file: the surface in motion, and
  /// plots of statistics.csv. Throws UserError, with nothing written, for a directory that is none of a
  /// run, and for a file that stands there and is no such page.
  ExportedPage
  export_page(const std::filesystem::path &directory, const std::filesystem::path &file);
} // namespace Exemplar::Live

#endif
