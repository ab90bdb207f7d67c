// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_shape_h
#define exemplar_point_shape_h

#include <exemplar/run/adjoint/laws_with_derivatives.h>

// The deformation gradient F = R S in the form that a law needs, in the frame of its rotation, and
// derivatives transformed back.

namespace Exemplar
{
  /// R^T P of an energy that has the derivative T by S: T + W with the skew W of Eq. (17).
  template <typename Number>
  Matrix3<Number>
  with_turn(const Matrix3<Number> &S, const Matrix3<Number> &T)
  {
    Matrix3<Number> B = combine(Number(-1.), S, Number(0.), S);
    for (int i = 0; i < 3; ++i)
      B[i][i] += trace(S);
    const Vector3<Number> turn   = cofactors(B) * axial_vector(commutator(S, T));
    const Number          factor = Number(1.) / determinant(B);
    return combine(Number(1.), T, factor, skew_matrix(turn));
  }

  /// Derivatives by F, and by its change dF along a direction.
  struct ShapeDerivatives
  {
    Matrix3<double> by_F, by_dF;
  };

  /// S of F = R S for laws with rotations, whose energy depends on S alone; else F itself.
  class PointShape
  {
  public:
    /// Takes F and its change dF along a direction.
    PointShape(const bool has_rotations, const Matrix3<double> &F, const Matrix3<double> &dF)
        : has_rotations(has_rotations), R(identity_matrix<double>()), turn{}, value(F), change(dF)
    {
      if (!has_rotations)
        return;
      R                       = closest_rotation(F);
      value                   = symmetric_part(transpose_times(R, F));
      const Matrix3<double> M = transpose_times(R, dF);
      // Eq. (18): the equation of W with M in the place of the products
      Matrix3<double> B = combine(-1., value, 0., value), skew;
      for (int i = 0; i < 3; ++i)
      {
        B[i][i] += trace(value);
        for (int j = 0; j < 3; ++j)
          skew[i][j] = M[i][j] - M[j][i];
      }
      turn   = times(1. / determinant(B), skew_matrix(cofactors(B) * axial_vector(skew)));
      change = symmetric_part(combine(1., M, -1., turn * value));
    }

    /// The matrix S, or F.
    const Matrix3<double> &
    get_value() const
    {
      return value;
    }

    const Matrix3<double> &
    get_change() const
    {
      return change;
    }

    /// Whether the value is S, which is symmetric.
    bool
    is_turned() const
    {
      return has_rotations;
    }

    /// Derivatives by F and dF of a potential with this R^T P.
    ShapeDerivatives
    derivatives(const Matrix3<HyperDual<0>> &of) const
    {
      Matrix3<double> by_value, by_change;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
          by_change[i][j] = of[i][j].value;
          by_value[i][j]  = of[i][j].change;
        }
      if (!has_rotations)
        return { by_value, by_change };
      return { R * combine(1., turn * by_change, 1., by_value), R * by_change };
    }

  private:
    bool            has_rotations;
    Matrix3<double> R, turn; ///< R and R^T dR
    Matrix3<double> value, change;
  };
} // namespace Exemplar

#endif
