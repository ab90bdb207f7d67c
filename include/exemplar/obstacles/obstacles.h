// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacles_h
#define exemplar_obstacles_h

#include <exemplar/obstacles/obstacle.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace Exemplar
{
  /// A number of a part of the body and a part of an obstacle that may meet.
  using PairKey = std::uint64_t;

  /// The obstacles of a scene.
  struct Obstacles
  {
    /// `diameter` is the body's [m]. Throws UserError as Obstacle and ObstaclesParameters::distance_of().
    Obstacles(const ObstaclesParameters &parameters,
              double                     diameter,
              const ObstacleSurfaces    &surfaces);

    /// Whether one of them stands elsewhere at these times [s].
    bool
    move_between(double time, double other_time) const;

    bool
    have_friction() const;

    std::vector<Obstacle> all;
    double                width;         ///< d_hat: from where they push [m]
    double                slip_speed;    ///< [m/s]
    double                lag_tolerance; ///< part of the greatest normal force
    /// Widths of pairs that began nearer than `width`, of each obstacle [m].
    std::vector<std::unordered_map<PairKey, double>> start_widths;
  };
} // namespace Exemplar

#endif
