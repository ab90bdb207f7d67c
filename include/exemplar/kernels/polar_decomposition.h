// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_polar_decomposition_h
#define exemplar_polar_decomposition_h

#include <exemplar/kernels/matrix3.h>

namespace Exemplar
{
  /// The rotation R that maximises tr(R^T F): the factor of F = R S where R is always proper (det
  /// +1) and S symmetric; S has one negative eigenvalue if det F < 0. Where R is not unique (rank
  /// of F below 2, or a mirrored F whose two smallest singular values agree) one of the maximisers
  /// is returned; F = 0 gives the identity. The result depends on F alone, never on history.
  ///
  /// Horn (1987), Eq. (14): with R = R(q), tr(R^T F) = q^T K q for a symmetric traceless 4x4 matrix
  /// K, whose greatest eigenvalue is tr S. It is found by Newton's method on the characteristic
  /// polynomial, which converges monotonically from above. With it R is a polynomial of F by Cayley
  /// and Hamilton, Eq. (14b), and one Newton step on the group of rotations removes rounding
  /// errors. Where two eigenvalues nearly coincide both are ill-conditioned, and Jacobi's method is
  /// used instead. Not inlined, as compilers contract products and sums of each copy in their own way
  /// and all loops must find the same bits for the same F.
  template <typename Number>
  [[gnu::noinline]] Matrix3<Number>
  closest_rotation(const Matrix3<Number> &F);

  namespace Polar
  {
    /// Symmetric 4x4 matrix, as a full array.
    template <typename Number>
    struct Matrix4
    {
      Number value[4][4];
    };

    /// A quaternion; a rotation if its norm is one.
    template <typename Number>
    struct Quaternion
    {
      Number value[4]; ///< w, x, y, z
    };

    template <typename Number>
    Matrix4<Number>
    horn_matrix(const Matrix3<Number> &F)
    {
      const Number wx = F[2][1] - F[1][2], wy = F[0][2] - F[2][0], wz = F[1][0] - F[0][1];
      const Number xy = F[0][1] + F[1][0], xz = F[0][2] + F[2][0], yz = F[1][2] + F[2][1];
      return { { { trace(F), wx, wy, wz },
                 { wx, F[0][0] - F[1][1] - F[2][2], xy, xz },
                 { wy, xy, F[1][1] - F[0][0] - F[2][2], yz },
                 { wz, xz, yz, F[2][2] - F[0][0] - F[1][1] } } };
    }

    template <typename Number>
    Matrix3<Number>
    rotation_matrix(const Quaternion<Number> &q)
    {
      const Number w = q.value[0], x = q.value[1], y = q.value[2], z = q.value[3];
      const Number two = Number(2.);
      return { { { w * w + x * x - y * y - z * z, two * (x * y - w * z), two * (x * z + w * y) },
                 { two * (x * y + w * z), w * w - x * x + y * y - z * z, two * (y * z - w * x) },
                 { two * (x * z - w * y), two * (y * z + w * x),
                   w * w - x * x - y * y + z * z } } };
    }

    /// Eigenvector of the greatest eigenvalue by cyclic Jacobi rotations; robust where eigenvalues
    /// coincide.
    template <typename Number>
    Quaternion<Number>
    eigenvector_by_jacobi(Matrix4<Number> K)
    {
      Number V[4][4];
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          V[i][j] = Number(i == j ? 1. : 0.);
      const auto rotate = [](Number &a, Number &b, const Number &c, const Number &s)
      {
        const Number old_a = a;
        a                  = c * old_a - s * b;
        b                  = s * old_a + c * b;
      };
      const int n_sweeps = 8; // five suffice, and more cost little once K is diagonal
      for (int sweep = 0; sweep < n_sweeps; ++sweep)
        for (int p = 0; p < 3; ++p)
          for (int q = p + 1; q < 4; ++q)
          {
            const Number t = jacobi_tangent(K.value[p][p], K.value[p][q], K.value[q][q]);
            const Number c = Number(1.) / sqrt(t * t + Number(1.));
            const Number s = t * c;
            for (int k = 0; k < 4; ++k)
              rotate(K.value[k][p], K.value[k][q], c, s);
            for (int k = 0; k < 4; ++k)
              rotate(K.value[p][k], K.value[q][k], c, s);
            for (int k = 0; k < 4; ++k)
              rotate(V[k][p], V[k][q], c, s);
          }
      Number             maximum = K.value[0][0];
      Quaternion<Number> q       = { { V[0][0], V[1][0], V[2][0], V[3][0] } };
      for (int i = 1; i < 4; ++i)
      {
        const auto is_greater = K.value[i][i] > maximum;
        maximum               = select(is_greater, K.value[i][i], maximum);
        for (int k = 0; k < 4; ++k)
          q.value[k] = select(is_greater, V[k][i], q.value[k]);
      }
      return q;
    }

    /// F over its greatest entry, I if F = 0.
    template <typename Number>
    Matrix3<Number>
    scaled(Matrix3<Number> F)
    {
      Number maximum = Number(0.);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          maximum = max(maximum, abs(F[i][j]));
      const auto is_zero = maximum == Number(0.);
      maximum            = select(is_zero, Number(1.), maximum);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          F[i][j] = select(is_zero, Number(i == j ? 1. : 0.), F[i][j] / maximum);
      return F;
    }

    /// A Newton step from R, correct to first order, to the rotation of G. With the skew part of
    /// R^T G = S + skew, the correction omega solves (tr(S) I - S) omega = axial(skew - skew^T); R
    /// (3 I - R^T R) / 2 is orthogonal to second order.
    template <typename Number>
    Matrix3<Number>
    polished(const Matrix3<Number> &R, const Matrix3<Number> &G)
    {
      const Matrix3<Number> M = transpose_times(R, G), C = transpose_times(R, R);
      Matrix3<Number>       B = symmetric_part(M);
      const Number          t = trace(B);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          B[i][j] = (i == j ? t : Number(0.)) - B[i][j];
      const Vector3<Number> axial = { { M[2][1] - M[1][2], M[0][2] - M[2][0], M[1][0] - M[0][1] } };
      Vector3<Number>       omega = cofactors(B) * axial;
      const Number          factor = Number(1.) / determinant(B);
      for (int i = 0; i < 3; ++i)
        omega[i] *= factor;
      Matrix3<Number> correction;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          correction[i][j] = Number(-0.5) * C[i][j] + (i == j ? Number(1.5) : Number(0.));
      correction[2][1] += omega[0];
      correction[1][2] -= omega[0];
      correction[0][2] += omega[1];
      correction[2][0] -= omega[1];
      correction[1][0] += omega[2];
      correction[0][1] -= omega[2];
      return R * correction;
    }
  } // namespace Polar

  template <typename Number>
  Matrix3<Number>
  closest_rotation(const Matrix3<Number> &F)
  {
    // fourth powers must neither over- nor underflow
    Matrix3<Number> G = F;
    Number          n = contract(F, F);
    if (!all((n > Number(1e-60)) & (n < Number(1e60))))
    {
      G = Polar::scaled(F);
      n = contract(G, G);
    }

    // chi(l) = l^4 - 2 n l^2 - 8 det(G) l + n^2 - 4 |cof G|^2 with n = |G|^2
    const Matrix3<Number> cof = cofactors(G);
    const Number          det = G[0][0] * cof[0][0] + G[0][1] * cof[0][1] + G[0][2] * cof[0][2];
    const Number          constant  = n * n - Number(4.) * contract(cof, cof);
    const Number          maximum   = sqrt(Number(3.) * n);
    const Number          accuracy  = Number(1e-8) * maximum;
    const Number          eight_det = Number(8.) * det;
    Number                lambda    = maximum;
    Number                slope     = Number(0.);
    for (int iteration = 0; iteration < 30; ++iteration)
    {
      const Number square = lambda * lambda;
      const Number value  = (square - (n + n)) * square - eight_det * lambda + constant;
      slope               = Number(4.) * lambda * (square - n) - eight_det;
      const Number step   = select(slope > Number(0.), value / slope, Number(0.));
      lambda -= step;
      if (all(abs(step) <= accuracy)) // the next step would be its square
        break;
    }
    slope = Number(4.) * lambda * (lambda * lambda - n) - eight_det;

    // slope = product of the distances to the three other eigenvalues = 8 (s_1+s_2)(s_2+s_3)
    // (s_3+s_1); it is 12.3 n^(3/2) at rest and 0 where the rotation is not unique
    const Number          I_2      = Number(0.5) * (lambda * lambda - n);
    const Number          factor_G = lambda * lambda - I_2;
    const Number          scale    = Number(8.) / slope;
    const Matrix3<Number> GC       = G * transpose_times(G, G);
    Matrix3<Number>       R;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        R[i][j] = scale * (lambda * cof[i][j] + factor_G * G[i][j] - GC[i][j]);
    // errors grow as 1 / slope^2 far from rest
    const Number size = maximum * n;
    if (any(slope < size)) // slope is 7.1 size at rest
      R = select_matrix(slope < size, Polar::polished(R, G), R);
    const auto is_ambiguous = !(slope > Number(0.006) * size);
    if (any(is_ambiguous))
      R = select_matrix(is_ambiguous,
                        Polar::rotation_matrix(Polar::eigenvector_by_jacobi(Polar::horn_matrix(G))),
                        R);
    return R;
  }
} // namespace Exemplar

#endif
