// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_hinge_angle_h
#define exemplar_hinge_angle_h

#include <exemplar/kernels/vector_product.h>

#include <array>
#include <cmath>

// The angle between two triangles that share an edge, and its derivatives in closed form. No deal.II
// header here: see matrix3.h.

namespace Exemplar
{
  /// A linear form of the velocities of the four nodes of a hinge: its vectors.
  template <typename Number>
  using HingeForm = std::array<Vector3<Number>, 4>;

  /// A product factor (a b^T + b a^T) of two forms at the vertices of a triangle.
  template <typename Number>
  struct SideProduct
  {
    Number                         factor;
    std::array<Vector3<Number>, 3> a, b;
  };

  /// A triangle at an edge: its unit normal n, the unit direction e of the edge, t = e x n, which
  /// points out of the triangle, and the foot of its height on the edge.
  template <typename Number>
  struct HingeSide
  {
    HingeSide(const Vector3<Number> &begin, const Vector3<Number> &end, const Vector3<Number> &apex)
    {
      const Vector3<Number> edge = difference(end, begin), to_apex = difference(apex, begin);
      const Vector3<Number> area = cross(edge, to_apex);
      const Number          size = Exemplar::norm(area);
      length                     = Exemplar::norm(edge);
      height                     = size / length;
      foot                       = dot(to_apex, edge) / (length * length);
      e                          = times(Number(1.) / length, edge);
      n                          = times(Number(1.) / size, area);
      t                          = cross(e, n);
    }

    /// The form of d.w/h at (begin, end, apex), where w is the velocity of the apex less that of
    /// the foot, for a direction d.
    std::array<Vector3<Number>, 3>
    of_height(const Vector3<Number> &d) const
    {
      const Number per_height = Number(1.) / height;
      return { { times((foot - Number(1.)) * per_height, d), times(-foot * per_height, d),
                 times(per_height, d) } };
    }

    /// The derivative of the turn of the normal about the edge, against e, by (begin, end, apex).
    std::array<Vector3<Number>, 3>
    of_turn() const
    {
      return of_height(times(Number(-1.), n));
    }

    /// Its second derivative. The turn accelerates by -2 rho y + 2 tau (z - kappa/2) when nodes have velocities v and no
    /// acceleration: with (rho, y, z) = (n, t, e).w/h and (tau, kappa) = (n, t).(v1 - v0)/l.
    std::array<SideProduct<Number>, 2>
    second_of_turn() const
    {
      const Number                   per_length = Number(1.) / length;
      const Vector3<Number>          tau        = times(per_length, n);
      const Vector3<Number>          kappa      = times(Number(0.5) * per_length, t);
      std::array<Vector3<Number>, 3> z          = of_height(e);
      z[0]                                      = combine(Number(1.), z[0], Number(1.), kappa);
      z[1]                                      = difference(z[1], kappa);
      return { { { Number(-1.), of_height(n), of_height(t) },
                 { Number(1.), { { times(Number(-1.), tau), tau, Vector3<Number>{} } }, z } } };
    }

    Vector3<Number> e, n, t;
    Number          length, height;
    Number          foot; ///< s: 0 at the begin of the edge, 1 at its end
  };

  /// A product factor (a b^T + b a^T) of two forms.
  template <typename Number>
  struct HingeProduct
  {
    Number            factor;
    HingeForm<Number> a, b;
  };

  /// The angle in [-pi, pi] by which the normal of triangle (x0, x1, x2) must turn about the edge
  /// x1 - x0 to be that of triangle (x1, x0, x3): 0 in a plane, and positive where the normals
  /// diverge.
  template <typename Number>
  class HingeAngle
  {
  public:
    HingeAngle(const Vector3<Number> &x0,
               const Vector3<Number> &x1,
               const Vector3<Number> &x2,
               const Vector3<Number> &x3)
        : x{ { x0, x1, x2, x3 } }, edge(difference(x1, x0)), a(difference(x2, x0)),
          b(difference(x3, x0)), normal_a(cross(edge, a)), normal_b(cross(b, edge)),
          square(dot(edge, edge)), length(sqrt(square))
    {
    }

    Number
    value() const
    {
      using std::atan2;
      return atan2(length * dot(edge, cross(b, a)), dot(normal_a, normal_b));
    }

    /// Its derivatives by the four nodes [1/m]: -n/h at an apex.
    HingeForm<Number>
    gradient() const
    {
      const HingeForm<Number> a = gradient_of_side(0), b = gradient_of_side(1);
      HingeForm<Number>       sum;
      for (int i = 0; i < 4; ++i)
        sum[i] = combine(Number(1.), a[i], Number(1.), b[i]);
      return sum;
    }

    /// What triangle (x0, x1, x2) gives to that, or (x1, x0, x3): the turn of its normal about the edge, against that of the other one.
    HingeForm<Number>
    gradient_of_side(const int side) const
    {
      // n/h, and the part of the apex in its foot at x1; without a root, as it is found in each iteration
      const Vector3<Number> &normal = side == 0 ? normal_a : normal_b;
      const Vector3<Number>  rho    = times(length / dot(normal, normal), normal);
      const Number           s      = dot(side == 0 ? a : b, edge) / square;
      HingeForm<Number>      form{ { times(Number(1.) - s, rho), times(s, rho), {}, {} } };
      form[2 + side] = times(Number(-1.), rho);
      return form;
    }

    /// The second derivative, the sum of two products for each side.
    std::array<HingeProduct<Number>, 4>
    hessian() const
    {
      const auto first = hessian_of_side(0), second = hessian_of_side(1);
      return { { first[0], first[1], second[0], second[1] } };
    }

    /// The derivative of gradient_of_side().
    std::array<HingeProduct<Number>, 2>
    hessian_of_side(const int side) const
    {
      const std::array<int, 3> at = { { side, 1 - side, 2 + side } };
      const auto products = HingeSide<Number>(x[at[0]], x[at[1]], x[at[2]]).second_of_turn();
      return { { placed(products[0], at), placed(products[1], at) } };
    }

  private:
    /// The product of forms at the nodes of a side, by those of the hinge.
    static HingeProduct<Number>
    placed(const SideProduct<Number> &of_side, const std::array<int, 3> &nodes)
    {
      HingeProduct<Number> product{ of_side.factor, {}, {} };
      for (int i = 0; i < 3; ++i)
      {
        product.a[nodes[i]] = of_side.a[i];
        product.b[nodes[i]] = of_side.b[i];
      }
      return product;
    }

    std::array<Vector3<Number>, 4> x;
    Vector3<Number>                edge, a, b; ///< x1, x2 and x3 from x0 on
    Vector3<Number>                normal_a, normal_b;
    Number                         square, length; ///< of the edge
  };

} // namespace Exemplar

#endif
