// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_vectors_h
#define exemplar_surface_vectors_h

#include <array>
#include <cmath>

namespace Exemplar
{
  /// Arithmetic of places and vectors as surfaces have them.
  using SpaceVector = std::array<double, 3>;

  inline SpaceVector
  minus(const SpaceVector &a, const SpaceVector &b)
  {
    return { { a[0] - b[0], a[1] - b[1], a[2] - b[2] } };
  }

  /// a + t b
  inline SpaceVector
  plus(const SpaceVector &a, const double t, const SpaceVector &b)
  {
    return { { a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2] } };
  }

  inline double
  dot(const SpaceVector &a, const SpaceVector &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  inline SpaceVector
  cross(const SpaceVector &a, const SpaceVector &b)
  {
    return { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } };
  }

  inline double
  norm(const SpaceVector &a)
  {
    return std::sqrt(dot(a, a));
  }

  /// Six times the volume of the tetrahedron; positive if d is where a, b, c are clockwise.
  inline double
  six_volumes(const SpaceVector &a,
              const SpaceVector &b,
              const SpaceVector &c,
              const SpaceVector &d)
  {
    return dot(cross(minus(b, a), minus(c, a)), minus(d, a));
  }
} // namespace Exemplar

#endif
