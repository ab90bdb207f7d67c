// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_solid_angle_h
#define exemplar_solid_angle_h

#include <exemplar/obstacles/closest_features.h>

#include <cmath>

namespace Exemplar
{
  /// The solid angle of a triangle, positive if its corners are clockwise as seen from the point
  /// (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125).
  inline double
  solid_angle(const SpaceVector3 &point, const std::array<SpaceVector3, 3> &x)
  {
    const SpaceVector3 a = x[0] - point, b = x[1] - point, c = x[2] - point;
    const double       A = a.norm(), B = b.norm(), C = c.norm();
    return 2.
           * std::atan2(a * dealii::cross_product_3d(b, c),
                        A * B * C + (a * b) * C + (b * c) * A + (c * a) * B);
  }

  /// Whether the sum of solid angles of triangles that enclose something tells that the point is inside.
  inline bool
  is_full_angle(const double sum)
  {
    constexpr double pi = 3.14159265358979324;
    return std::abs(sum) > 2. * pi;
  }
} // namespace Exemplar

#endif
