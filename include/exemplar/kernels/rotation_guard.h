// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_rotation_guard_h
#define exemplar_rotation_guard_h

#include <exemplar/kernels/lanes.h>
#include <exemplar/kernels/matrix3.h>

// Derivatives of rotations, and the guard of Eq. (16) where rotations are hardly unique. No deal.II
// header here: see matrix3.h.

namespace Exemplar
{
  /// The axial vector a of the skew matrix W, W b = a x b.
  template <typename Number>
  Vector3<Number>
  axial_vector(const Matrix3<Number> &W)
  {
    return { { W[2][1], W[0][2], W[1][0] } };
  }

  template <typename Number>
  Matrix3<Number>
  skew_matrix(const Vector3<Number> &a)
  {
    const Number zero = Number(0.);
    return { { { zero, -a[2], a[1] }, { a[2], zero, -a[0] }, { -a[1], a[0], zero } } };
  }

  template <typename Number>
  Matrix3<Number>
  commutator(const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    const Matrix3<Number> AB = A * B, BA = B * A;
    Matrix3<Number>       C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = AB[i][j] - BA[i][j];
    return C;
  }

  /// (s_1+s_2)(s_2+s_3)(s_3+s_1) of a stretch S with the principal stretches s_i.
  template <typename Number>
  Number
  product_of_sums(const Matrix3<Number> &S)
  {
    Matrix3<Number> B = combine(Number(-1.), S, Number(0.), S);
    for (int k = 0; k < 3; ++k)
      B[k][k] += trace(S);
    return determinant(B);
  }

  /// The guard phi = z^2 (3 - 2 z), z = clamp(p/p_0, 0, 1), and its derivatives by p. The product
  /// p = (s_1+s_2)(s_2+s_3)(s_3+s_1) of the singular values, s_3 < 0 in a mirrored cell, is 8 at
  /// rest and 0 where the rotation is ambiguous and the energy with an example would jump.
  template <typename Number>
  struct Guard
  {
    Number phi;
    Number derivative;
    Number second;
  };

  template <typename Number>
  Guard<Number>
  guard(const Number &p, const Number &p_0)
  {
    const Number z         = max(p / p_0, Number(0.));
    const auto   is_beyond = p >= p_0;
    return { select(is_beyond, Number(1.), z * z * (Number(3.) - Number(2.) * z)),
             select(is_beyond, Number(0.), Number(6.) * z * (Number(1.) - z) / p_0),
             select(is_beyond, Number(0.),
                    Number(6.) * (Number(1.) - Number(2.) * z) / (p_0 * p_0)) };
  }

  /// Inverse of the symmetric positive semidefinite matrix B = tr(S) I - S with its eigenvalues
  /// s_i + s_j bounded below by `minimum`.
  template <typename Number>
  Matrix3<Number>
  bounded_inverse(const Matrix3<Number> &B, const Number &minimum)
  {
    return spectral_function(B, [&minimum](const Number &eigenvalue)
                             { return Number(1.) / max(eigenvalue, minimum); });
  }
} // namespace Exemplar

#endif
