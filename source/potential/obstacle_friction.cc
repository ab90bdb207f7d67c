// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/obstacle_term.h>

#include <algorithm>
#include <tuple>

// Friction of an obstacle term: what rubs, since when, and how far it has slipped.

namespace Exemplar
{
  void
  ObstacleTerm::remember_slip_base(const State &at)
  {
    TouchingTerm::remember_slip_base(at, step);
    const std::vector<WeightedPositions> history
        = integrator != nullptr ? integrator->history(at)
                                : std::vector<WeightedPositions>{ { 1., &at.positions } };
    step.earlier.clear();
    double time_then = at.time;
    for (const WeightedPositions &then : history)
    {
      step.earlier.push_back({ then.weight, standing });
      for (StandingObstacle &obstacle : step.earlier.back().standing)
        obstacle.move_to(time_then);
      time_then -= at.previous_step;
    }
  }

  std::optional<Rubbing>
  ObstacleTerm::rubbing_of(const Contact &contact) const
  {
    const Obstacle        &obstacle = obstacles.all[contact.obstacle];
    std::optional<Rubbing> at
        = TouchingTerm::rubbing_of(contact, contact.pair.key(), obstacle.friction());
    if (!at)
      return at;
    at->own_place = standing[contact.obstacle].pose.to_own(contact.of_obstacle);
    at->shares    = contact.at.nearest.b;
    if (obstacle.deforms())
    {
      const ObstacleShape &shape = obstacle.shape();
      const unsigned int   part  = contact.pair.of_obstacle;
      if (contact.pair.kind == PairKind::node_triangle)
        at->vertices = shape.triangles[part];
      else if (contact.pair.kind == PairKind::edge_edge)
        at->vertices = { { shape.edges[part][0], shape.edges[part][1], 0 } };
      else
        at->vertices = { { shape.points[part], 0, 0 } };
    }
    return at;
  }

  std::vector<Rubbing>
  ObstacleTerm::rubbing_at(const Vector &positions) const
  {
    std::vector<Rubbing> result;
    for (const Contact &contact : touches(positions))
      if (const auto at = rubbing_of(contact))
        result.push_back(*at);
    std::sort(result.begin(), result.end(),
              [](const Rubbing &a, const Rubbing &b)
              { return std::tie(a.obstacle, a.key) < std::tie(b.obstacle, b.key); });
    return result;
  }

  TermChange
  ObstacleTerm::renew(const TermPoint &at)
  {
    if (!have_friction || !step.has_begun || step.n_renewals > max_renewals)
      return TermChange::none;
    ++step.n_looks;
    return renew_friction(rubbing_at(at.positions), obstacles.lag_tolerance, step);
  }

  SpaceVector3
  ObstacleTerm::motion_along(const Rubbing &at, const Vector &positions) const
  {
    const StandingObstacle &now = standing[at.obstacle];
    SpaceVector3            u   = -now.pose.to_space(at.own_place);
    for (const Earlier &before : step.earlier)
    {
      const StandingObstacle &then     = before.standing[at.obstacle];
      SpaceVector3            own_then = at.own_place;
      if (now.obstacle->deforms())
        for (unsigned int k = 0; k < 3; ++k)
          own_then += at.shares[k] * (then.vertices[at.vertices[k]] - now.vertices[at.vertices[k]]);
      u += before.weight * then.pose.to_space(own_then);
    }
    for (unsigned int i = 0; i < at.gap.n_nodes; ++i)
      u += at.gap.coefficients[i]
           * (at_node(positions, at.gap.nodes[i]) - at_node(step.slip_base, at.gap.nodes[i]));
    return u;
  }

  std::optional<double>
  ObstacleTerm::dissipation(const State &end) const
  {
    if (!have_friction)
      return {};
    return heat_of_all(end.positions);
  }
} // namespace Exemplar
