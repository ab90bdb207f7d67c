// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_gaps_h
#define exemplar_obstacle_gaps_h

#include <exemplar/obstacles/obstacle.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  /// Two obstacles, and the distance between them.
  struct ObstacleGap
  {
    unsigned int first, second;
    double       size; ///< [m]
  };

  /// The narrowest gap between two obstacles that is wider than `least` and narrower than `greatest` [m]; nothing if there is none.
  /// Obstacles that touch or overlap have no gap, and those that move relative to each other between these times [s], of which the
  /// first is looked at, or change their form, are left out.
  std::optional<ObstacleGap>
  narrowest_gap(const std::vector<Obstacle> &obstacles,
                const std::vector<double>   &times,
                double                       least,
                double                       greatest);
} // namespace Exemplar

#endif
