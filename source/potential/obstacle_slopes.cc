// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/obstacle_term.h>

// Derivatives of the slope of an obstacle term, for gradients.

namespace Exemplar
{
  NoGradients
  ObstacleTerm::no_gradients() const
  {
    constexpr double greatest_lag = 1e-6;
    for (const Obstacle &obstacle : obstacles.all)
    {
      const std::string name = "Obstacles/" + obstacle.name();
      if (!obstacle.is_always_there())
        return { "beside obstacles that come or go, as " + name + " does",
                 "Leave out its From and Until." };
      if (obstacle.friction() > 0. && obstacle.deforms())
        return { "of friction on a surface whose vertices move by themselves, as those of " + name,
                 "Set its Friction to 0, or leave out its Follow cache." };
    }
    if (have_friction && obstacles.lag_tolerance > greatest_lag)
      return { "of friction whose normal forces are not those of the step's end",
               "Set Obstacles/Lag tolerance to 1e-10, or to 1e-6 at most." };
    return {};
  }

  ContactMotion
  ObstacleTerm::motion_of(const Rubbing &at, const Vector &positions) const
  {
    ContactMotion motion;
    motion.slip   = motion_along(at, positions);
    motion.places = at_nodes(at.gap, positions);
    motion.ways   = motion.places;
    for (unsigned int i = 0; i < at.gap.n_nodes; ++i)
      motion.ways[i] -= at_node(step.slip_base, at.gap.nodes[i]);
    const auto from_space = dealii::transpose(standing[at.obstacle].pose.rotation);
    for (const Earlier &before : step.earlier)
      motion.by_point += before.weight * before.standing[at.obstacle].pose.rotation * from_space;
    for (unsigned int c = 0; c < 3; ++c)
      motion.by_point[c][c] -= 1.;
    return motion;
  }

  void
  ObstacleTerm::add_origins(const Contact      &contact,
                            const ContactSlope &slope,
                            ShareDerivatives   &by_shares,
                            TouchingSlopes     &sums) const
  {
    const unsigned int of_body  = contact.pair.of_body;
    const double       by_share = contact_stiffness_factor * slope.by_stiffness;
    if (contact.pair.kind == PairKind::edge_edge)
    {
      by_shares.edges[of_body] += by_share;
      by_shares.squares[of_body] += slope.by_square / surface.edges[of_body].square;
    }
    else if (contact.pair.kind == PairKind::triangle_point)
      by_shares.triangles[of_body] += by_share;
    else
      by_shares.nodes[of_body] += by_share;
    TouchingSlopes::OfObstacle &of_obstacle = sums.of_obstacles[contact.obstacle];
    for (unsigned int i = 0; i < contact.gap.n_nodes; ++i)
      of_obstacle.by_place -= slope.by_positions[i] + slope.by_start[i];
    of_obstacle.by_radius -= slope.by_distance;
    of_obstacle.by_coefficient += slope.by_coefficient;
    const StartWidth *own = obstacles.own_width(contact.obstacle, contact.pair.key());
    if (own == nullptr)
      return;
    of_obstacle.by_place -= slope.by_width * own->normal;
    of_obstacle.by_radius -= slope.by_width;
    for (unsigned int i = 0; i < contact.gap.n_nodes; ++i)
      add_to(sums.by_first_positions, contact.gap.nodes[i],
             slope.by_width * own->shares[i] * own->normal);
  }

  TouchingSlopes
  ObstacleTerm::slopes(const Vector &positions, const Vector &along, const FESpace &fe_space) const
  {
    TouchingSlopes sums(positions.size(), fe_space.n_cells());
    if (have_friction)
      sums.by_start.reinit(positions.size());
    sums.of_obstacles.resize(obstacles.all.size());
    ShareDerivatives by_shares = surface.no_derivatives();
    for (const Contact &contact : contacts(positions))
    {
      if (!(contact.gap.distance > 0.))
        continue;
      const ContactGradient a     = at_nodes(contact.gap, along);
      ContactSlope          slope = slope_of_barrier(contact, a);
      if (const auto at = step.has_begun ? rubbing_of(contact) : std::nullopt)
        add_slope_of_friction(contact, slip_energy(*at), at->coefficient, motion_of(*at, positions),
                              a, slope);
      add_at_nodes(contact.gap, slope.by_positions, sums.by_positions);
      if (have_friction)
        add_at_nodes(contact.gap, slope.by_start, sums.by_start);
      add_origins(contact, slope, by_shares, sums);
    }
    surface.carry(by_shares, material, fe_space, sums.by_young, sums.by_rest_positions);
    return sums;
  }
} // namespace Exemplar
