// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/polar_decomposition.h>
#include <exemplar/surface/posing/fold_energy.h>

#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    /// A function of the determinant with its first two derivatives.
    struct OfDeterminant
    {
      double value, first, second;
    };

    /// chi, Eq. (3): near the determinant if it is positive, small but positive if not.
    OfDeterminant
    regularised(const double det, const double eps)
    {
      const double root = std::sqrt(eps * eps + det * det);
      const double chi  = det > 0. ? 0.5 * (det + root) : 0.5 * eps * eps / (root - det);
      return { chi, chi / root, 0.5 * eps * eps / (root * root * root) };
    }

    /// chi^(-2/3), the factor of |F|^2.
    OfDeterminant
    shape_factor(const OfDeterminant &chi)
    {
      const double value = 1. / std::cbrt(chi.value * chi.value), rate = chi.first / chi.value;
      return { value, -2. / 3. * value * rate,
               value * (10. / 9. * rate * rate - 2. / 3. * chi.second / chi.value) };
    }

    /// (det^2 + 1) / chi, the volumetric term.
    OfDeterminant
    volume_term(const OfDeterminant &chi, const double det)
    {
      const double numerator = det * det + 1., rate = chi.first / chi.value;
      return { numerator / chi.value, (2. * det - numerator * rate) / chi.value,
               (2. - 4. * det * rate + numerator * (2. * rate * rate - chi.second / chi.value))
                   / chi.value };
    }

    Matrix3<double>
    times_transpose(const Matrix3<double> &A, const Matrix3<double> &B)
    {
      Matrix3<double> C;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          C[i][j] = A[i][0] * B[j][0] + A[i][1] * B[j][1] + A[i][2] * B[j][2];
      return C;
    }

    /// F = U diag(s) V^T with rotations U and V; the least stretch is negative if det F is.
    struct Stretches
    {
      Matrix3<double> U, V;
      Vector3<double> s;
    };

    Stretches
    stretches_of(const Matrix3<double> &F)
    {
      const Matrix3<double> R     = closest_rotation(F);
      const auto            eigen = symmetric_eigensystem(symmetric_part(transpose_times(R, F)));
      return { R * eigen.vectors, eigen.vectors, eigen.values };
    }

    /// The energy's second derivative by the three stretches, and what the turns and shears need:
    /// the curvature is 2 h + turning s_k for turns about axis k, 2 h - turning s_k for shears.
    struct Curvatures
    {
      Matrix3<double> stretch;
      double          square, turning;
    };

    Curvatures
    curvatures(const Vector3<double> &s, const double eps)
    {
      const double        det = s[0] * s[1] * s[2];
      const OfDeterminant chi = regularised(det, eps), h = shape_factor(chi),
                          g       = volume_term(chi, det);
      const double          norm  = dot(s, s);
      const double          slope = norm * h.first + g.first, bend = norm * h.second + g.second;
      const Vector3<double> c = { { s[1] * s[2], s[2] * s[0], s[0] * s[1] } };
      Curvatures            result{ {}, 2. * h.value, slope };
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          result.stretch[i][j] = 2. * h.first * (s[i] * c[j] + c[i] * s[j]) + bend * c[i] * c[j]
                                 + (i == j ? 2. * h.value : slope * s[3 - i - j]);
      return result;
    }
  } // namespace

  double
  fold_energy(const Matrix3<double> &F, const double eps)
  {
    const double det = determinant(F);
    if (eps == 0. && !(det > 0.))
      return std::numeric_limits<double>::infinity();
    const OfDeterminant chi = regularised(det, eps);
    return contract(F, F) * shape_factor(chi).value + volume_term(chi, det).value - 5.;
  }

  Matrix3<double>
  fold_stress(const Matrix3<double> &F, const double eps)
  {
    const double        det = determinant(F);
    const OfDeterminant chi = regularised(det, eps), h = shape_factor(chi);
    return combine(2. * h.value, F, contract(F, F) * h.first + volume_term(chi, det).first,
                   cofactors(F));
  }

  FoldModes
  fold_modes(const Matrix3<double> &F, const double eps)
  {
    const Stretches  stretches = stretches_of(F);
    const Curvatures curvature = curvatures(stretches.s, eps);
    FoldModes        modes;
    int              mode = 0;
    const auto       add  = [&](const double stiffness, const Matrix3<double> &in_axes)
    {
      modes.stiffness[mode]   = stiffness;
      modes.direction[mode++] = stretches.U * times_transpose(in_axes, stretches.V);
    };
    const double half = std::sqrt(0.5);
    for (int k = 0; k < 3; ++k)
      for (const double sign : { -1., 1. })
      {
        Matrix3<double> in_axes{};
        in_axes[(k + 1) % 3][(k + 2) % 3] = half;
        in_axes[(k + 2) % 3][(k + 1) % 3] = sign * half;
        add(curvature.square - sign * curvature.turning * stretches.s[k], in_axes);
      }
    const auto eigen = symmetric_eigensystem(curvature.stretch);
    for (int e = 0; e < 3; ++e)
    {
      Matrix3<double> in_axes{};
      for (int i = 0; i < 3; ++i)
        in_axes[i][i] = eigen.vectors[i][e];
      add(eigen.values[e], in_axes);
    }
    return modes;
  }
} // namespace Exemplar
