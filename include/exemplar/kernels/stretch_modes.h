// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_stretch_modes_h
#define exemplar_stretch_modes_h

#include <exemplar/kernels/corotational_cell.h>

#include <array>

// Terms that the convex tangent R K R^T lacks in strongly stretched cells: the resistance of a
// stretched cell to rotation, and the guard's stiffness. Without them Newton's steps are many times
// too long there. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A non-negative quadratic form sum_m stiffness_m (direction_m : M)^2 / 2 of M = R^T dF.
  struct StretchModes
  {
    std::array<double, 9>          stiffness; ///< [Pa]
    std::array<Matrix3<double>, 9> direction; ///< orthonormal
  };

  /// Whether a cell is stretched so far that the guard of stretch_guard.h may act.
  inline bool
  is_strongly_stretched(const KinkSlope<double> &kink)
  {
    return kink.slope > -kink.margin;
  }

  /// The positive part of the difference between the exact tangent of a cell without examples, its
  /// target set, and R K R^T. Both have the same principal modes (Smith et al. 2019): with the
  /// eigenvectors v_i of S these are the three rotations v_i v_j^T - v_j v_i^T, the three shears
  /// v_i v_j^T + v_j v_i^T, and combinations of the three stretches v_i v_i^T.
  inline StretchModes
  stretch_modes(const CorotationalCell<double> &cell,
                const Matrix3<double>          &rotation,
                const Matrix3<double>          &deformation_gradient)
  {
    const Matrix3<double> V
        = symmetric_eigensystem(symmetric_part(transpose_times(rotation, deformation_gradient)))
              .vectors;
    const auto product = [&V](const int i, const int j)
    {
      Matrix3<double> A;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          A[k][l] = V[k][i] * V[l][j];
      return A;
    };
    const auto difference = [&](const Matrix3<double> &M)
    { return combine(1., cell.response(M), -1., stress(cell.own_material(), symmetric_part(M))); };

    StretchModes modes;
    int          mode = 0;
    const auto   add  = [&](const double stiffness, const Matrix3<double> &direction)
    {
      modes.stiffness[mode]   = max(stiffness, 0.);
      modes.direction[mode++] = direction;
    };
    const double half = std::sqrt(0.5);
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      for (const double sign : { -half, half })
      {
        const Matrix3<double> direction = combine(half, product(i, j), sign, product(j, i));
        add(contract(direction, difference(direction)), direction);
      }
    }
    Matrix3<double> H;
    for (int j = 0; j < 3; ++j)
    {
      const Matrix3<double> change = difference(product(j, j));
      for (int i = 0; i < 3; ++i)
        H[i][j] = contract(product(i, i), change);
    }
    const Eigensystem<double> stretches = symmetric_eigensystem(symmetric_part(H));
    for (int e = 0; e < 3; ++e)
    {
      Matrix3<double> direction{};
      for (int i = 0; i < 3; ++i)
        direction = combine(1., direction, stretches.vectors[i][e], product(i, i));
      add(stretches.values[e], direction);
    }
    return modes;
  }
} // namespace Exemplar

#endif
