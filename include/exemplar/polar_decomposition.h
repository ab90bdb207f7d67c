// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_polar_decomposition_h
#define exemplar_polar_decomposition_h

#include <exemplar/matrix3.h>

#include <cmath>
#include <utility>

namespace Exemplar
{
  /// The rotation R that maximises tr(R^T F), that is the factor of F = R S with
  /// R proper (det +1) always and S symmetric; S has one negative eigenvalue if
  /// det F < 0. Where R is not unique (rank of F below 2, or a mirrored F whose two
  /// smallest singular values agree) one of the maximisers is returned; F = 0
  /// gives the identity. The result depends on F alone, never on history.
  ///
  /// Horn (1987), Eq. (14): with R = R(q), tr(R^T F) = q^T K q for a symmetric traceless 4x4
  /// matrix K, so q is the eigenvector of its greatest eigenvalue. That eigenvalue
  /// is found by Newton's method on the characteristic polynomial, from above,
  /// which is monotone. Where two eigenvalues nearly coincide the polynomial is
  /// ill-conditioned, and Jacobi's method takes over.
  template <typename Number>
  Matrix3<Number>
  closest_rotation(const Matrix3<Number> &F);

  namespace Polar
  {
    /// Symmetric 4x4 matrix, as a full array.
    template <typename Number>
    struct Matrix4
    {
      Number value[4][4];
    };

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

    template <typename Number>
    Number
    rayleigh_quotient(const Matrix4<Number> &K, const Quaternion<Number> &q)
    {
      Number sum = Number(0.);
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          sum += q.value[i] * K.value[i][j] * q.value[j];
      return sum;
    }

    /// Eigenvector of K to the simple eigenvalue lambda: the longest column of the
    /// adjugate of K - lambda I, which is a multiple of q q^T.
    template <typename Number>
    Quaternion<Number>
    eigenvector(const Matrix4<Number> &K, const Number &lambda)
    {
      Number M[4][4];
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          M[i][j] = (i == j ? K.value[i][j] - lambda : K.value[i][j]);

      // 2x2 minors of rows 0,1 (upper) and of rows 2,3 (lower)
      const auto minor = [&M](const int row, const int j, const int k)
      { return M[row][j] * M[row + 1][k] - M[row][k] * M[row + 1][j]; };
      const Number u01 = minor(0, 0, 1), u02 = minor(0, 0, 2), u03 = minor(0, 0, 3);
      const Number u12 = minor(0, 1, 2), u13 = minor(0, 1, 3), u23 = minor(0, 2, 3);
      const Number l01 = minor(2, 0, 1), l02 = minor(2, 0, 2), l03 = minor(2, 0, 3);
      const Number l12 = minor(2, 1, 2), l13 = minor(2, 1, 3), l23 = minor(2, 2, 3);

      const Number adjugate[4][4] = { { M[1][1] * l23 - M[1][2] * l13 + M[1][3] * l12,
                                        -(M[0][1] * l23 - M[0][2] * l13 + M[0][3] * l12),
                                        M[3][1] * u23 - M[3][2] * u13 + M[3][3] * u12,
                                        -(M[2][1] * u23 - M[2][2] * u13 + M[2][3] * u12) },
                                      { -(M[1][0] * l23 - M[1][2] * l03 + M[1][3] * l02),
                                        M[0][0] * l23 - M[0][2] * l03 + M[0][3] * l02,
                                        -(M[3][0] * u23 - M[3][2] * u03 + M[3][3] * u02),
                                        M[2][0] * u23 - M[2][2] * u03 + M[2][3] * u02 },
                                      { M[1][0] * l13 - M[1][1] * l03 + M[1][3] * l01,
                                        -(M[0][0] * l13 - M[0][1] * l03 + M[0][3] * l01),
                                        M[3][0] * u13 - M[3][1] * u03 + M[3][3] * u01,
                                        -(M[2][0] * u13 - M[2][1] * u03 + M[2][3] * u01) },
                                      { -(M[1][0] * l12 - M[1][1] * l02 + M[1][2] * l01),
                                        M[0][0] * l12 - M[0][1] * l02 + M[0][2] * l01,
                                        -(M[3][0] * u12 - M[3][1] * u02 + M[3][2] * u01),
                                        M[2][0] * u12 - M[2][1] * u02 + M[2][2] * u01 } };

      int longest = 0;
      for (int i = 1; i < 4; ++i)
        if (std::abs(adjugate[i][i]) > std::abs(adjugate[longest][longest]))
          longest = i;

      Number norm_square = Number(0.);
      for (int i = 0; i < 4; ++i)
        norm_square += adjugate[i][longest] * adjugate[i][longest];
      const Number       scale = Number(1.) / std::sqrt(norm_square);
      Quaternion<Number> q;
      for (int i = 0; i < 4; ++i)
        q.value[i] = scale * adjugate[i][longest];
      return q;
    }

    /// Eigenvector to the greatest eigenvalue by cyclic Jacobi rotations; never
    /// fails, also where eigenvalues coincide.
    template <typename Number>
    Quaternion<Number>
    eigenvector_by_jacobi(Matrix4<Number> K)
    {
      Number V[4][4]
          = { { 1., 0., 0., 0. }, { 0., 1., 0., 0. }, { 0., 0., 1., 0. }, { 0., 0., 0., 1. } };
      const auto rotate = [](Number &a, Number &b, const Number &c, const Number &s)
      {
        const Number old_a = a;
        a                  = c * old_a - s * b;
        b                  = s * old_a + c * b;
      };
      const int n_sweeps = 8; // five suffice; the rest costs nothing once it is diagonal
      for (int sweep = 0; sweep < n_sweeps; ++sweep)
        for (int p = 0; p < 3; ++p)
          for (int q = p + 1; q < 4; ++q)
          {
            const Number off_diagonal = K.value[p][q];
            if (off_diagonal == Number(0.))
              continue;
            const Number theta = (K.value[q][q] - K.value[p][p]) / (Number(2.) * off_diagonal);
            const Number sign  = theta >= Number(0.) ? Number(1.) : Number(-1.);
            const Number t     = sign / (std::abs(theta) + std::sqrt(theta * theta + Number(1.)));
            const Number c     = Number(1.) / std::sqrt(t * t + Number(1.));
            const Number s     = t * c;
            for (int k = 0; k < 4; ++k)
              rotate(K.value[k][p], K.value[k][q], c, s);
            for (int k = 0; k < 4; ++k)
              rotate(K.value[p][k], K.value[q][k], c, s);
            for (int k = 0; k < 4; ++k)
              rotate(V[k][p], V[k][q], c, s);
          }
      int greatest = 0;
      for (int i = 1; i < 4; ++i)
        if (K.value[i][i] > K.value[greatest][greatest])
          greatest = i;
      return { { V[0][greatest], V[1][greatest], V[2][greatest], V[3][greatest] } };
    }
  } // namespace Polar

  template <typename Number>
  Matrix3<Number>
  closest_rotation(const Matrix3<Number> &F)
  {
    // Scale by the greatest entry first, so that squares neither over- nor underflow.
    Number greatest = Number(0.);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (std::abs(F[i][j]) > greatest)
          greatest = std::abs(F[i][j]);
    if (!(greatest > Number(0.)))
      return identity_matrix<Number>();

    Matrix3<Number> G;
    Number          norm_square = Number(0.);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        G[i][j] = F[i][j] / greatest;
        norm_square += G[i][j] * G[i][j];
      }
    const Number scale = Number(1.) / std::sqrt(norm_square);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        G[i][j] *= scale;

    // p(l) = l^4 - 2 l^2 - 8 det(G) l + 1 - 4 |cof G|^2 for |G| = 1
    const Number          det      = determinant(G);
    const Matrix3<Number> cof      = cofactors(G);
    const Number          constant = Number(1.) - Number(4.) * contract(cof, cof);
    Number                lambda   = std::sqrt(Number(3.));
    Number                slope    = Number(0.);
    for (int iteration = 0; iteration < 30; ++iteration)
    {
      const Number square = lambda * lambda;
      slope               = Number(4.) * lambda * (square - Number(1.)) - Number(8.) * det;
      const Number value  = square * (square - Number(2.)) - Number(8.) * det * lambda + constant;
      if (!(slope > Number(0.)) || std::abs(value) <= Number(1e-14) * slope)
        break;
      lambda -= value / slope;
    }

    // slope = product of the distances to the three other eigenvalues; it is 12.3
    // at rest and 0 where the rotation is not unique.
    const Polar::Matrix4<Number> K = Polar::horn_matrix(G);
    if (!(slope > Number(1e-3)))
      return Polar::rotation_matrix(Polar::eigenvector_by_jacobi(K));
    Polar::Quaternion<Number> q = Polar::eigenvector(K, lambda);
    if (!(slope > Number(1.))) // an eigenvalue less sharp: one Rayleigh step makes up for it
      q = Polar::eigenvector(K, Polar::rayleigh_quotient(K, q));
    return Polar::rotation_matrix(q);
  }
} // namespace Exemplar

#endif
