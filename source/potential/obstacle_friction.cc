// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/obstacle_term.h>

#include <algorithm>
#include <cmath>
#include <tuple>

// Friction of an obstacle term: what rubs, since when, and how far it has slipped.

namespace Exemplar
{
  void
  ObstacleTerm::remember_slip_base(const State &at)
  {
    step.rate = integrator != nullptr ? integrator->rate_factor() : 1. / step.size;
    const std::vector<WeightedPositions> history
        = integrator != nullptr ? integrator->history(at)
                                : std::vector<WeightedPositions>{ { 1., &at.positions } };
    step.slip_base.reinit(at.positions.size());
    step.earlier.clear();
    double time_then = at.time;
    for (const WeightedPositions &then : history)
    {
      step.slip_base.add(then.weight, *then.positions);
      step.earlier.push_back({ then.weight, standing });
      for (StandingObstacle &obstacle : step.earlier.back().standing)
        obstacle.move_to(time_then);
      time_then -= at.previous_step;
    }
  }

  std::optional<Rubbing>
  ObstacleTerm::rubbing_of(const Contact &contact) const
  {
    const Obstacle &obstacle = obstacles.all[contact.obstacle];
    const Gap      &gap      = contact.gap;
    if (obstacle.friction() == 0. || !(gap.distance > 0.) || gap.stiffness == 0.)
      return {};
    Rubbing at{ contact.obstacle,
                contact.pair.key(),
                gap,
                -Barrier{ gap.stiffness, gap.width }.slope(gap.distance),
                obstacle.friction(),
                standing[contact.obstacle].pose.to_own(contact.of_obstacle),
                {},
                contact.at.nearest.b };
    if (obstacle.deforms())
    {
      const ObstacleShape &shape = obstacle.shape();
      const unsigned int   part  = contact.pair.of_obstacle;
      if (contact.pair.kind == PairKind::node_triangle)
        at.vertices = shape.triangles[part];
      else if (contact.pair.kind == PairKind::edge_edge)
        at.vertices = { { shape.edges[part][0], shape.edges[part][1], 0 } };
      else
        at.vertices = { { shape.points[part], 0, 0 } };
    }
    return at;
  }

  std::vector<Rubbing>
  ObstacleTerm::rubbing_at(const Vector &positions) const
  {
    std::vector<Rubbing> result;
    for (const Contact &contact : contacts(positions))
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
    std::vector<Rubbing> fresh            = rubbing_at(at.positions);
    const auto [own_greatest, own_change] = force_and_change_of(fresh, step.rubbing);
    const double greatest                 = free_dofs->exchange().max(own_greatest);
    const double change                   = free_dofs->exchange().max(own_change);
    // where a step begins nothing may push yet
    const bool lets_go = springs && (greatest > 0. || !step.is_beginning) && springs->let_go();
    step.is_beginning  = false;
    if (change <= obstacles.lag_tolerance * greatest)
      return lets_go ? TermChange::values : TermChange::none;
    ++step.n_renewals;
    step.rubbing = std::move(fresh);
    return TermChange::values;
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

  SpaceVector3
  ObstacleTerm::slip(const Rubbing &at, const Vector &positions) const
  {
    const SpaceVector3 u = motion_along(at, positions);
    return u - (u * at.gap.normal) * at.gap.normal;
  }

  std::optional<double>
  ObstacleTerm::dissipation(const State &end) const
  {
    if (!have_friction)
      return {};
    double heat = 0.;
    for (const Rubbing &at : step.rubbing)
      heat += heat_of(at, end.positions);
    return heat;
  }

  double
  ObstacleTerm::heat_of(const Rubbing &at, const Vector &positions) const
  {
    // of a velocity that lasts for the step
    return step.rate * step.size * slip_energy(at).heat(slip(at, positions).norm());
  }
} // namespace Exemplar
