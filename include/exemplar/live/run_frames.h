// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_run_frames_h
#define exemplar_live_run_frames_h

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// A frame of a finished run.
  struct RunFrame
  {
    double                time; ///< [s]
    std::filesystem::path file;
  };

  /// Of the animation in the output directory of a run. Throws UserError unless it has frames in the format vtu.
  std::vector<RunFrame>
  frames_of_run(const std::filesystem::path &directory);

  /// Places of the nodes, by coordinate [m]. Throws UserError for a file that no run has written.
  std::vector<double>
  places_in(const std::filesystem::path &file);

  /// The boundary of the cells in a frame: of each triangle its nodes, outwards.
  std::vector<std::array<unsigned int, 3>>
  boundary_in(const std::filesystem::path &file);
} // namespace Exemplar::Live

#endif
