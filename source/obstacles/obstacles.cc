// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/obstacles/obstacles.h>

#include <algorithm>

namespace Exemplar
{
  Obstacles::Obstacles(const ObstaclesParameters &parameters,
                       const double               diameter,
                       const ObstacleSurfaces    &surfaces)
      : width(parameters.distance_of(diameter)), slip_speed(parameters.slip_speed_of(diameter)),
        lag_tolerance(parameters.lag_tolerance), start_widths(parameters.named.size())
  {
    for (const ObstacleParameters &obstacle : parameters.named)
    {
      const auto surface = surfaces.find(obstacle.name);
      if (surface == surfaces.end() && !obstacle.surface_file().empty())
        throw UserError("Obstacles/" + obstacle.name
                        + "/Shape: its surface is not among the inputs. Read it from its file, or "
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
