// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/obstacles/obstacles.h>

#include <algorithm>
#include <utility>

namespace Exemplar
{
  Obstacles::Obstacles(const ObstaclesParameters &parameters,
                       const double               diameter,
                       PieceSizes                 piece_sizes,
                       const ObstacleSurfaces    &surfaces)
      : sizes(std::move(piece_sizes)),
        widths(contact_distances(parameters.distance, "Obstacles/Distance", diameter, sizes)),
        width(widths.greatest()), slip_speeds(contact_slip_speeds(parameters.slip_speed, sizes)),
        lag_tolerance(parameters.lag_tolerance), free(parameters.free), diameter(diameter),
        start_widths(parameters.named.size())
  {
    for (const ObstacleParameters &obstacle : parameters.named)
    {
      const auto surface = surfaces.find(obstacle.name);
      if (surface == surfaces.end()
          && !(obstacle.surface_file().empty() && obstacle.follow_track.empty()))
        throw UserError(
            "Obstacles/" + obstacle.name
            + ": its surface or track is not among the inputs. Read it from its file, or "
              "hand it in.");
      all.emplace_back(obstacle, surface == surfaces.end() ? nullptr : &surface->second);
    }
  }

  bool
  Obstacles::move_between(const double time, const double other_time) const
  {
    return std::any_of(all.begin(), all.end(),
                       [&](const Obstacle &obstacle)
                       { return obstacle.moves_between(time, other_time); });
  }

  bool
  Obstacles::have_friction() const
  {
    return std::any_of(all.begin(), all.end(),
                       [](const Obstacle &obstacle) { return obstacle.friction() > 0.; });
  }
} // namespace Exemplar
