// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_vectors_h
#define exemplar_surface_vectors_h

#include <array>
#include <cmath>

namespace Exemplar
{
  /// Arithmetic of places and vectors as surfaces have them.
  using Vector3 = std::array<double, 3>;

  inline Vector3
  minus(const Vector3 &a, const Vector3 &b)
  {
    return { { a[0] - b[0], a[1] - b[1], a[2] - b[2] } };
  }

  /// a + t b
  inline Vector3
  plus(const Vector3 &a, const double t, const Vector3 &b)
  {
    return { { a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2] } };
  }

  inline double
  dot(const Vector3 &a, const Vector3 &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  inline Vector3
  cross(const Vector3 &a, const Vector3 &b)
  {
    return { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } };
  }

  inline double
  norm(const Vector3 &a)
  {
    return std::sqrt(dot(a, a));
  }

  /// Six times the volume of the tetrahedron; positive if d is where a, b, c are clockwise.
  inline double
  six_volumes(const Vector3 &a, const Vector3 &b, const Vector3 &c, const Vector3 &d)
  {
    return dot(cross(minus(b, a), minus(c, a)), minus(d, a));
  }
} // namespace Exemplar

#endif
