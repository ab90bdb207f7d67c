// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacles_h
#define exemplar_obstacles_h

#include <exemplar/obstacles/obstacle.h>
#include <exemplar/obstacles/piece_sizes.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace Exemplar
{
  /// A number of a part of the body and a part of an obstacle that may meet.
  using PairKey = std::uint64_t;

  /// The width of a pair that began nearer than all others push from: its distance then.
  struct StartWidth
  {
    double                width;  ///< [m]
    std::array<double, 3> shares; ///< of the body's nodes of the pair
    SpaceVector3 normal; ///< the width's gradient by a node's first place is its share of this
  };

  /// The obstacles of a scene.
  struct Obstacles
  {
    /// `diameter` is the whole body's [m]. Throws UserError as Obstacle and contact_distances().
    Obstacles(const ObstaclesParameters &parameters,
              double                     diameter,
              PieceSizes                 sizes,
              const ObstacleSurfaces    &surfaces);

    /// Whether one of them stands elsewhere at these times [s].
    bool
    move_between(double time, double other_time) const;

    bool
    have_friction() const;

    /// The width of a pair of an obstacle's own; null: it has none.
    const StartWidth *
    own_width(const unsigned int obstacle, const PairKey key) const
    {
      const auto found = start_widths[obstacle].find(key);
      return found == start_widths[obstacle].end() ? nullptr : &found->second;
    }

    std::vector<Obstacle> all;
    PieceSizes            sizes;
    PieceLengths          widths;        ///< d_hat: from where they push a piece [m]
    double                width;         ///< the greatest one of these [m]
    PieceLengths          slip_speeds;   ///< [m/s]
    double                lag_tolerance; ///< part of the greatest normal force
    FreeBodies            free;          ///< what holds a static body
    double                diameter;      ///< of the body [m]
    /// Of pairs that began nearer than `width`, of each obstacle.
    std::vector<std::unordered_map<PairKey, StartWidth>> start_widths;
  };
} // namespace Exemplar

#endif
