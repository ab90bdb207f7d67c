// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/contact_forces.h>

namespace Exemplar
{
  namespace
  {
    /// With all of its stiffness.
    Barrier
    full_barrier(const Contact &contact)
    {
      return { contact.full_stiffness, contact.gap.width };
    }

    /// By the vector of the body's edge and its two nodes.
    constexpr std::array<double, 3> signs_of_edge{ { -1., 1., 0. } };
  } // namespace

  double
  energy_of(const Contact &contact)
  {
    const double full = full_barrier(contact).value(contact.gap.distance);
    return contact.m == 0. && contact.gap.distance > 0. ? 0.
           : contact.m == 1.                            ? full
                                                        : contact.m * full;
  }

  ContactGradient
  gradient_of(const Contact &contact)
  {
    const Barrier   barrier = full_barrier(contact);
    const Gap      &gap     = contact.gap;
    const double    slope   = contact.m * barrier.slope(gap.distance);
    ContactGradient result;
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      result[i] = slope * gap.coefficients[i] * gap.normal;
    if (contact.m < 1.)
      for (unsigned int i = 0; i < 2; ++i)
        result[i] += signs_of_edge[i] * barrier.value(gap.distance) * contact.by_edge;
    return result;
  }

  namespace
  {
    /// The second derivative of the distance: that of the least square over the free parameters, of which that of
    /// its root follows.
    ContactHessian
    curvature_of_distance(const Contact &contact)
    {
      ContactHessian result;
      const Nearest &at     = contact.at.nearest;
      const double   length = at.way.norm();
      const unsigned n      = contact.gap.n_nodes;
      if (contact.at.is_flat || length == 0.)
        return result;
      // inverse of the Gram matrix of dv; parameters of parallel edges are one
      dealii::Tensor<2, 2> inverse;
      if (at.n_free == 2)
      {
        const double a = at.dv[0] * at.dv[0], b = at.dv[0] * at.dv[1], d = at.dv[1] * at.dv[1];
        const double determinant = a * d - b * b;
        if (determinant > 1e-14 * a * d)
        {
          inverse[0][0] = d / determinant;
          inverse[1][1] = a / determinant;
          inverse[0][1] = inverse[1][0] = -b / determinant;
        }
        else if (a > 0.)
          inverse[0][0] = 1. / a;
      }
      else if (at.n_free == 1)
        inverse[0][0] = 1. / (at.dv[0] * at.dv[0]);
      std::array<std::array<SpaceVector3, 2>, 3> mixed; // d^2 (v^2/2) / dx dtheta
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int k = 0; k < at.n_free; ++k)
          mixed[i][k] = at.a[i] * at.dv[k] + at.da[k][i] * at.way;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
        {
          dealii::Tensor<2, 3> &block = result[i][j];
          for (unsigned int c = 0; c < 3; ++c)
            block[c][c] = at.a[i] * at.a[j];
          for (unsigned int k = 0; k < at.n_free; ++k)
            for (unsigned int l = 0; l < at.n_free; ++l)
              block -= inverse[k][l] * dealii::outer_product(mixed[i][k], mixed[j][l]);
          block
              -= at.a[i] * at.a[j] * dealii::outer_product(contact.gap.normal, contact.gap.normal);
          block /= length;
        }
      return result;
    }
  } // namespace

  ContactHessian
  hessian_of(const Contact &contact, const Tangent kind)
  {
    const Barrier  barrier   = full_barrier(contact);
    const Gap     &gap       = contact.gap;
    const double   d         = gap.distance;
    const double   curvature = contact.m * barrier.curvature(d), slope = barrier.slope(d);
    const auto     n_n = dealii::outer_product(gap.normal, gap.normal);
    ContactHessian result;
    if (kind == Tangent::exact)
      result = curvature_of_distance(contact);
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      for (unsigned int j = 0; j < gap.n_nodes; ++j)
      {
        const double c_i = gap.coefficients[i], c_j = gap.coefficients[j];
        result[i][j] *= contact.m * slope;
        result[i][j] += curvature * c_i * c_j * n_n;
        if (kind == Tangent::convex || contact.m == 1.)
          continue;
        const double s_i = signs_of_edge[i], s_j = signs_of_edge[j];
        result[i][j] += slope
                            * (c_i * s_j * dealii::outer_product(gap.normal, contact.by_edge)
                               + s_i * c_j * dealii::outer_product(contact.by_edge, gap.normal))
                        + barrier.value(d) * s_i * s_j * contact.by_edge_twice;
      }
    return result;
  }

  double
  SlipEnergy::value(const double slip) const
  {
    const double s = slip / e;
    return greatest * (s < 1. ? slip * s * (1. - s / 3.) : slip - e / 3.);
  }

  double
  SlipEnergy::force_by_slip(const double slip) const
  {
    const double s = slip / e;
    return greatest * (s < 1. ? (2. - s) / e : 1. / slip);
  }

  dealii::Tensor<2, 3>
  SlipEnergy::curvature(const SpaceVector3 &slip, const SpaceVector3 &normal) const
  {
    const double         y      = slip.norm();
    dealii::Tensor<2, 3> result = -dealii::outer_product(normal, normal);
    for (unsigned int c = 0; c < 3; ++c)
      result[c][c] += 1.;
    result *= force_by_slip(y);
    if (y > 0.)
    {
      // along the slip f'' takes the place of f' / y
      const double second = y < e ? greatest * 2. / e * (1. - y / e) : 0.;
      result += (second - force_by_slip(y)) / (y * y) * dealii::outer_product(slip, slip);
    }
    return result;
  }
} // namespace Exemplar
