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
    std::filesystem::path obstacles = {}; ///< the file that shows them; empty: none
  };

  /// The frames of the animation in the output directory of a run. Throws UserError unless it has
  /// frames in the format vtu.
  std::vector<RunFrame>
  frames_of_run(const std::filesystem::path &directory);

  /// Positions of the nodes in a frame, three coordinates each [m]. Throws UserError for a file
  /// that no run has written.
  std::vector<double>
  places_in(const std::filesystem::path &file);

  /// The polygons in a frame of obstacles, by their points.
  std::vector<std::vector<unsigned int>>
  polygons_in(const std::filesystem::path &file);

  /// Positions of the nodes at rest, as places_in() has them in a frame.
  std::vector<double>
  rest_places_in(const std::filesystem::path &file);

  /// The boundary of the cells in a frame: the three nodes of each triangle, counterclockwise from
  /// outside.
  std::vector<std::array<unsigned int, 3>>
  boundary_in(const std::filesystem::path &file);
} // namespace Exemplar::Live

#endif
