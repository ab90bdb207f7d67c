// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/contact_slopes.h>
#include <exemplar/potential/nodal_vectors.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// How the part m of the energy of almost parallel edges, and its gradient by the edges, change with the logarithm of
    /// the square of one of these at rest.
    struct PartialEdge
    {
      explicit PartialEdge(const EdgePart &part)
      {
        if (part.m == 1.)
          return;
        // m = p (2 - p), and p goes with the inverse of the square
        const double p = part.m / (1. + std::sqrt(1. - part.m));
        m              = -2. * (1. - p) * p;
        by_gradient    = (2. * p - 1.) / (1. - p);
      }

      double m = 0., by_gradient = 0.; ///< times the gradient
    };

    /// The change of m where the nodes of two edges move by `along`. Those of an edge of an obstacle do not.
    double
    change_of_part(const Touch &touch, const ContactGradient &along)
    {
      if (touch.part.m == 1.)
        return 0.;
      double change = touch.part.by[0] * (along[1] - along[0]);
      if (touch.gap.n_nodes == 4)
        change += touch.part.by[1] * (along[3] - along[2]);
      return change;
    }

    SpaceVector3
    sum(const Gap &gap, const ContactGradient &of_nodes)
    {
      SpaceVector3 result;
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
        result += gap.coefficients[i] * of_nodes[i];
      return result;
    }

    SpaceVector3
    tangential(const SpaceVector3 &vector, const SpaceVector3 &normal)
    {
      return vector - (vector * normal) * normal;
    }
  } // namespace

  ContactGradient
  at_nodes(const Gap &gap, const Vector &field)
  {
    ContactGradient result{};
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      result[i] = at_node(field, gap.nodes[i]);
    return result;
  }

  void
  add_at_nodes(const Gap &gap, const ContactGradient &derivatives, Vector &to)
  {
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      add_to(to, gap.nodes[i], derivatives[i]);
  }

  ContactSlope
  slope_of_barrier(const Touch &touch, const ContactGradient &along)
  {
    const Gap           &gap = touch.gap;
    const double         d = gap.distance, k = touch.full_stiffness, m = touch.part.m;
    const Barrier        unit{ 1., gap.width };
    const PartialEdge    partial(touch.part);
    const double         closing = gap.normal * sum(gap, along);
    const double         m_along = change_of_part(touch, along);
    const ContactHessian hessian = hessian_of(touch, Tangent::exact);
    ContactSlope         result;
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      for (unsigned int j = 0; j < gap.n_nodes; ++j)
        result.by_positions[i] += hessian[i][j] * along[j];
    result.by_stiffness = m * unit.slope(d) * closing + unit.value(d) * m_along;
    result.by_width = k * (m * unit.slope_by_width(d) * closing + unit.value_by_width(d) * m_along);
    result.by_distance = k * (m * unit.curvature(d) * closing + unit.slope(d) * m_along);
    result.by_square
        = k * (partial.m * unit.slope(d) * closing + unit.value(d) * partial.by_gradient * m_along);
    return result;
  }

  namespace
  {
    /// Derivatives of a function by what the positions of a contact's nodes determine.
    struct ByContact
    {
      double                distance = 0., m = 0.;
      SpaceVector3          normal;
      std::array<double, 4> coefficients{};
    };

    /// Chain rule: add its derivatives by the positions.
    void
    carry(const Contact &contact, const ByContact &by, ContactGradient &by_positions)
    {
      const Gap     &gap = contact.gap;
      const Nearest &at  = contact.at.nearest;
      for (unsigned int j = 0; j < gap.n_nodes; ++j)
        by_positions[j] += by.distance * gap.coefficients[j] * gap.normal;
      if (contact.part.m < 1.)
      {
        by_positions[0] -= by.m * contact.part.by[0];
        by_positions[1] += by.m * contact.part.by[0];
      }
      if (contact.at.is_flat)
        return;
      // the normal is that of the way, which the free parameters change, too
      const SpaceVector3         by_way  = tangential(by.normal, gap.normal) / at.way.norm();
      const dealii::Tensor<2, 2> inverse = inverse_of_free(at);
      dealii::Tensor<1, 2>       by_free;
      for (unsigned int k = 0; k < at.n_free; ++k)
      {
        by_free[k] = at.dv[k] * by_way;
        for (unsigned int i = 0; i < gap.n_nodes; ++i)
          by_free[k] += by.coefficients[i] * at.da[k][i];
      }
      const dealii::Tensor<1, 2> weights = inverse * by_free;
      for (unsigned int j = 0; j < gap.n_nodes; ++j)
      {
        by_positions[j] += at.a[j] * by_way;
        for (unsigned int k = 0; k < at.n_free; ++k)
          by_positions[j] -= weights[k] * (at.a[j] * at.dv[k] + at.da[k][j] * at.way);
      }
    }
  } // namespace

  void
  add_slope_of_friction(const Contact         &contact,
                        const SlipEnergy      &energy,
                        const double           coefficient,
                        const ContactMotion   &motion,
                        const ContactGradient &along,
                        ContactSlope          &slope)
  {
    const Gap          &gap = contact.gap;
    const SpaceVector3 &n = gap.normal, &z = motion.slip;
    const SpaceVector3  u = tangential(z, n), a = sum(gap, along);
    const double        per_slip = energy.force_by_slip(u.norm());
    const double        value    = per_slip * (u * a);
    const double        d = gap.distance, k = contact.full_stiffness;
    const Barrier       unit{ 1., gap.width };
    // by the tangential slip, the slip, the obstacle's point
    const SpaceVector3 by_u     = energy.curvature(u, n) * a + per_slip * (n * a) * n;
    const SpaceVector3 by_slip  = tangential(by_u, n);
    const SpaceVector3 by_point = dealii::transpose(motion.by_point) * by_slip;
    // the normal force is -m k b'(d)
    const double by_force
        = coefficient * SlipEnergy{ 1., energy.e }.force_by_slip(u.norm()) * (u * a);
    ByContact by;
    by.distance = -by_force * contact.part.m * k * unit.curvature(d) - by_point * n;
    by.m        = -by_force * k * unit.slope(d);
    by.normal   = -(n * z) * by_u - (n * by_u) * z - d * by_point;
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
    {
      by.coefficients[i]
          = per_slip * (u * along[i]) + by_slip * motion.ways[i] + by_point * motion.places[i];
      slope.by_positions[i] += gap.coefficients[i] * (by_slip + by_point);
      slope.by_start[i] -= gap.coefficients[i] * by_slip;
    }
    carry(contact, by, slope.by_positions);
    slope.by_distance += by.distance;
    slope.by_stiffness -= by_force * contact.part.m * unit.slope(d);
    slope.by_width -= by_force * contact.part.m * k * unit.slope_by_width(d);
    slope.by_square += by.m * PartialEdge(contact.part).m;
    slope.by_coefficient += value / coefficient;
  }
} // namespace Exemplar
