// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/contact_slopes.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// How the part m of the energy of almost parallel edges, and its gradient by the body's edge, change with the
    /// logarithm of the square of that edge at rest.
    struct PartialEdge
    {
      explicit PartialEdge(const Contact &contact)
      {
        if (contact.part.m == 1.)
          return;
        // m = p (2 - p), and p goes with the inverse of the square
        const double p = contact.part.m / (1. + std::sqrt(1. - contact.part.m));
        m              = -2. * (1. - p) * p;
        by_edge        = (2. * p - 1.) / (1. - p) * contact.part.by[0];
      }

      double       m = 0.;
      SpaceVector3 by_edge;
    };

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

  ContactSlope
  slope_of_barrier(const Contact &contact, const ContactGradient &along)
  {
    const Gap           &gap = contact.gap;
    const double         d = gap.distance, k = contact.full_stiffness;
    const Barrier        unit{ 1., gap.width };
    const PartialEdge    partial(contact);
    const double         closing = gap.normal * sum(gap, along);
    const SpaceVector3   turning = contact.part.m < 1. ? along[1] - along[0] : SpaceVector3();
    const double         m_along = contact.part.by[0] * turning;
    const ContactHessian hessian = hessian_of(contact, Tangent::exact);
    ContactSlope         result;
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      for (unsigned int j = 0; j < gap.n_nodes; ++j)
        result.by_positions[i] += hessian[i][j] * along[j];
    result.by_stiffness = contact.part.m * unit.slope(d) * closing + unit.value(d) * m_along;
    result.by_width
        = k
          * (contact.part.m * unit.slope_by_width(d) * closing + unit.value_by_width(d) * m_along);
    result.by_distance
        = k * (contact.part.m * unit.curvature(d) * closing + unit.slope(d) * m_along);
    result.by_square
        = k * (partial.m * unit.slope(d) * closing + unit.value(d) * (partial.by_edge * turning));
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
    slope.by_square += by.m * PartialEdge(contact).m;
    slope.by_coefficient += value / coefficient;
  }
} // namespace Exemplar
