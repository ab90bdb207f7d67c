// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_crossings_h
#define exemplar_live_crossings_h

#include <exemplar/live/keyed_shapes.h>
#include <exemplar/live/run_motion.h>

#include <array>
#include <vector>

namespace Exemplar::Live
{
  /// Where a picture of a run shows surfaces that pass through each other although they do not in the run.
  struct Crossings
  {
    std::size_t n_frames = 0;  ///< in which they do
    double      deepest  = 0.; ///< depth of the deepest place [m]
  };

  /// Compares the frames of a picture with those of the run: places of the same vertices, which `triangles` connect. An edge is as deep in a triangle as the nearer one of its ends is behind the
  /// triangle's plane.
  Crossings
  crossings_of(const std::vector<std::array<unsigned int, 3>> &triangles,
               const std::vector<Places>                      &picture,
               const std::vector<Places>                      &run);

  /// The same of the body and the obstacles of a run, shown by shapes. What is worn may pass into the body.
  Crossings
  crossings_of(const RunMotion &motion, const KeyedShapes &shapes);
} // namespace Exemplar::Live

#endif
