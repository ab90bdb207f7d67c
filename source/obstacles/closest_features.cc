// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/closest_features.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    constexpr double negligible = 1e-12; ///< beside 1: rounding

    /// The part of the way from a to b at which a line is nearest to a point, within [0, 1].
    double
    part_on(const SpaceVector3 &a, const SpaceVector3 &b, const SpaceVector3 &point)
    {
      const SpaceVector3 edge   = b - a;
      const double       length = edge.norm_square();
      return length > 0. ? std::clamp((point - a) * edge / length, 0., 1.) : 0.;
    }

    /// Nearest point of the edge of a triangle between corners i and j.
    Nearest
    on_edge(const std::array<SpaceVector3, 3> &x,
            const SpaceVector3                &point,
            const unsigned int                 i,
            const unsigned int                 j)
    {
      const double s = part_on(x[i], x[j], point);
      Nearest      result;
      result.a[i] = 1. - s;
      result.a[j] = s;
      result.b[0] = 1.;
      result.way  = x[i] + s * (x[j] - x[i]) - point;
      if (s > 0. && s < 1.)
      {
        result.n_free   = 1;
        result.da[0][i] = -1.;
        result.da[0][j] = 1.;
        result.dv[0]    = x[j] - x[i];
      }
      return result;
    }
  } // namespace

  Nearest
  nearest(const std::array<SpaceVector3, 3> &x, const SpaceVector3 &point)
  {
    const SpaceVector3 e = x[1] - x[0], f = x[2] - x[0];
    const SpaceVector3 n    = dealii::cross_product_3d(e, f);
    const double       area = n.norm_square();
    if (area > 0.)
    {
      // barycentric coordinates by the two other corners, as areas seen along the normal
      const SpaceVector3 p = point - x[0];
      const double       s = dealii::cross_product_3d(p, f) * n / area;
      const double       t = dealii::cross_product_3d(e, p) * n / area;
      if (s > 0. && t > 0. && s + t < 1.)
      {
        Nearest result;
        result.a      = { { 1. - s - t, s, t } };
        result.b[0]   = 1.;
        result.way    = -(p * n / area) * n;
        result.n_free = 2;
        result.da     = { { { { -1., 1., 0. } }, { { -1., 0., 1. } } } };
        result.dv     = { { e, f } };
        return result;
      }
    }
    Nearest best  = on_edge(x, point, 0, 1);
    double  least = best.way.norm_square();
    for (const auto &[i, j] : { std::pair(1U, 2U), std::pair(2U, 0U) })
      if (const Nearest other = on_edge(x, point, i, j); other.way.norm_square() < least)
      {
        best  = other;
        least = best.way.norm_square();
      }
    return best;
  }

  namespace
  {
    Nearest
    between(const std::array<SpaceVector3, 2> &x,
            const std::array<SpaceVector3, 2> &q,
            const double                       s,
            const double                       t)
    {
      Nearest result;
      result.a          = { { 1. - s, s, 0. } };
      result.b          = { { 1. - t, t, 0. } };
      result.way        = (x[0] - q[0]) + s * (x[1] - x[0]) - t * (q[1] - q[0]);
      unsigned int free = 0;
      if (s > 0. && s < 1.)
      {
        result.da[free]   = { { -1., 1., 0. } };
        result.dv[free++] = x[1] - x[0];
      }
      if (t > 0. && t < 1.)
      {
        result.db[free]   = { { -1., 1., 0. } };
        result.dv[free++] = q[0] - q[1];
      }
      result.n_free = free;
      return result;
    }
  } // namespace

  Nearest
  nearest(const std::array<SpaceVector3, 2> &x, const std::array<SpaceVector3, 2> &q)
  {
    const SpaceVector3 e = x[1] - x[0], f = q[1] - q[0], r = x[0] - q[0];
    const double       ee = e * e, ff = f * f, ef = e * f;
    // the end points, each with the nearest point of the other edge, hold the best if the lines are parallel
    Nearest    best  = between(x, q, 0., part_on(q[0], q[1], x[0]));
    double     least = best.way.norm_square();
    const auto offer = [&](const double s, const double t)
    {
      const Nearest other  = between(x, q, s, t);
      const double  square = other.way.norm_square();
      if (square < least)
      {
        best  = other;
        least = square;
      }
    };
    offer(1., part_on(q[0], q[1], x[1]));
    offer(part_on(x[0], x[1], q[0]), 0.);
    offer(part_on(x[0], x[1], q[1]), 1.);
    const double determinant = dealii::cross_product_3d(e, f).norm_square();
    if (determinant > 0.)
    {
      const double s = (ef * (f * r) - ff * (e * r)) / determinant;
      const double t = (ee * (f * r) - ef * (e * r)) / determinant;
      if (s > 0. && s < 1. && t > 0. && t < 1.)
        offer(s, t);
    }
    return best;
  }

  Nearest
  reversed(const Nearest &of)
  {
    Nearest result = of;
    result.way *= -1.;
    std::swap(result.a, result.b);
    std::swap(result.da, result.db);
    for (SpaceVector3 &derivative : result.dv)
      derivative *= -1.;
    return result;
  }

  bool
  passes_through(const std::array<SpaceVector3, 2> &edge, const std::array<SpaceVector3, 3> &x)
  {
    const SpaceVector3 e = x[1] - x[0], f = x[2] - x[0], n = dealii::cross_product_3d(e, f);
    const double       begin = (edge[0] - x[0]) * n, end = (edge[1] - x[0]) * n;
    const double       longest
        = std::max({ e.norm(), f.norm(), (edge[0] - x[0]).norm(), (edge[1] - x[0]).norm() });
    // on flat parts of a surface rounding alone would say on which side the ends are
    const double rounding = negligible * e.norm() * f.norm() * longest;
    if (!(std::min(begin, end) < -rounding && std::max(begin, end) > rounding))
      return false;
    const double       area  = n.norm_square();
    const SpaceVector3 place = edge[0] + begin / (begin - end) * (edge[1] - edge[0]) - x[0];
    const double       s     = dealii::cross_product_3d(place, f) * n / area,
                 t           = dealii::cross_product_3d(e, place) * n / area;
    return std::min({ s, t, 1. - s - t }) >= -negligible;
  }
} // namespace Exemplar
