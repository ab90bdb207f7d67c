// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/body_contact_term.h>
#include <exemplar/potential/nodal_vectors.h>

#include <cmath>

// Derivatives of the slope of contact of the body with itself, for gradients.

namespace Exemplar
{
  namespace
  {
    /// Derivatives by the share and by the area of a side of a pair.
    struct BySide
    {
      double share = 0., area = 0.;
    };

    /// The part that the first of two numbers has in the least one: 1 or 0, or a half if they are the same but for
    /// rounding, as differences to both sides have it.
    double
    part_in_least(const double a, const double b)
    {
      constexpr double rounding = 1e-12;
      return std::abs(a - b) <= rounding * (a + b) ? 0.5 : a < b ? 1. : 0.;
    }

    /// Derivatives of the softer side's modulus times the lesser side's area, times a factor.
    template <typename Side, typename OtherSide>
    std::pair<BySide, BySide>
    by_sides(const Side &a, const OtherSide &b, const double factor)
    {
      const double modulus_a = a.share / a.area, modulus_b = b.share / b.area;
      const double softer  = part_in_least(modulus_a, modulus_b),
                   less    = part_in_least(a.area, b.area);
      const double modulus = std::min(modulus_a, modulus_b), area = std::min(a.area, b.area);
      const auto   of = [&](const double own_modulus, const double own_area,
                          const double part_of_modulus, const double part_of_area)
      {
        const double by_modulus = factor * area * part_of_modulus;
        return BySide{ by_modulus / own_area,
                       factor * modulus * part_of_area - by_modulus * own_modulus / own_area };
      };
      return { of(modulus_a, a.area, softer, less), of(modulus_b, b.area, 1. - softer, 1. - less) };
    }
  } // namespace

  NoGradients
  BodyContactTerm::no_gradients() const
  {
    if (contacts.friction == 0.)
      return {};
    return {
      "of friction between bodies, whose normal forces are not quite those of the step's end",
      "Set Contact/Friction to 0."
    };
  }

  void
  BodyContactTerm::add_origins(const BodyTouch    &touch,
                               const ContactSlope &slope,
                               ShareDerivatives   &by) const
  {
    const BodyPair &pair   = touch.pair;
    const double    factor = contact_stiffness_factor * slope.by_stiffness;
    if (pair.kind == BodyPairKind::edge_edge)
    {
      const auto sides = by_sides(surface.edges[pair.first], surface.edges[pair.second], factor);
      const auto add   = [&](const unsigned int edge, const BySide &of_side)
      {
        by.edges[edge] += of_side.share;
        by.areas_of_edges[edge] += of_side.area;
        by.squares[edge] += slope.by_square / surface.edges[edge].square;
      };
      add(pair.first, sides.first);
      add(pair.second, sides.second);
      return;
    }
    const auto sides = by_sides(surface.nodes[pair.first], surface.triangles[pair.second], factor);
    by.nodes[pair.first] += sides.first.share;
    by.areas_of_nodes[pair.first] += sides.first.area;
    by.triangles[pair.second] += sides.second.share;
    by.areas_of_triangles[pair.second] += sides.second.area;
  }

  TouchingSlopes
  BodyContactTerm::slopes(const Vector  &positions,
                          const Vector  &along,
                          const FESpace &fe_space) const
  {
    constexpr double     rounding = 1e-9;
    TouchingSlopes       sums(positions.size(), fe_space.n_cells());
    ShareDerivatives     by_shares = surface.no_derivatives();
    const BodyPairSearch search    = this->search();
    const Places         at_rest   = search.places_of(fe_space.rest_positions());
    for (const BodyTouch &touch : touches(positions))
    {
      if (!(touch.gap.distance > 0.))
        continue;
      ContactGradient along_points;
      for (unsigned int i = 0; i < 4; ++i)
        along_points[i] = points.value(along, touch.gap.nodes[i]);
      const ContactSlope slope = slope_of_barrier(touch, along_points);
      for (unsigned int i = 0; i < 4; ++i)
        points.add_to(sums.by_positions, touch.gap.nodes[i], slope.by_positions[i]);
      add_origins(touch, slope, by_shares);
      const auto [origin, part] = contacts.origin_of_width(surface, touch.pair);
      if (part == 0.)
        continue;
      const Gap then = search.touch_at(origin, at_rest).gap;
      if (std::abs(part * then.distance - touch.gap.width) > rounding * touch.gap.width)
        continue; // the body begins nearer than it is at rest, and has the width of that
      for (unsigned int i = 0; i < then.n_nodes; ++i)
        add_to(sums.by_rest_positions, then.nodes[i],
               part * slope.by_width * then.coefficients[i] * then.normal);
    }
    surface.carry(by_shares, material, fe_space, sums.by_young, sums.by_rest_positions);
    return sums;
  }
} // namespace Exemplar
