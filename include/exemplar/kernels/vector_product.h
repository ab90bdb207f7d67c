// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vector_product_h
#define exemplar_vector_product_h

#include <exemplar/kernels/matrix3.h>

// Products and sums of vectors for the kernels of shells. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// a x b.
  template <typename Number>
  Vector3<Number>
  cross(const Vector3<Number> &a, const Vector3<Number> &b)
  {
    return { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } };
  }

  /// a x + b y.
  template <typename Number>
  Vector3<Number>
  combine(const Number &a, const Vector3<Number> &x, const Number &b, const Vector3<Number> &y)
  {
    return { { a * x[0] + b * y[0], a * x[1] + b * y[1], a * x[2] + b * y[2] } };
  }

  /// a - b.
  template <typename Number>
  Vector3<Number>
  difference(const Vector3<Number> &a, const Vector3<Number> &b)
  {
    return { { a[0] - b[0], a[1] - b[1], a[2] - b[2] } };
  }

  /// factor a.
  template <typename Number>
  Vector3<Number>
  times(const Number &factor, const Vector3<Number> &a)
  {
    return { { factor * a[0], factor * a[1], factor * a[2] } };
  }

  /// |a|.
  template <typename Number>
  Number
  norm(const Vector3<Number> &a)
  {
    return sqrt(dot(a, a));
  }
} // namespace Exemplar

#endif
