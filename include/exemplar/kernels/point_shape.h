// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_shape_h
#define exemplar_point_shape_h

#include <exemplar/kernels/polar_decomposition.h>
#include <exemplar/kernels/rotation_guard.h>

// The deformation gradient F = R S in the form that a law needs, in the frame of its rotation, and
// derivatives transformed back. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// R^T P of an energy that has the derivative T by S: T + W with the skew W of Eq. (17).
  inline Matrix3<double>
  with_turn(const Matrix3<double> &S, const Matrix3<double> &T)
  {
    Matrix3<double> B = combine(-1., S, 0., S);
    for (int i = 0; i < 3; ++i)
      B[i][i] += trace(S);
    return combine(1., T, 1.,
                   skew_matrix(inverse_of_symmetric(B) * axial_vector(commutator(S, T))));
  }

  /// A matrix, and its change along a direction.
  template <typename Number>
  struct ChangingMatrix
  {
    Matrix3<Number> value{}, change{};
  };

  using MatrixAlong = ChangingMatrix<double>;

  /// Derivatives by F, and by its change dF along a direction.
  template <typename Number>
  struct ShapeDerivatives
  {
    Matrix3<Number> by_F, by_dF;
  };

  /// S of F = R S for laws with rotations, whose energy depends on S alone; else F itself.
  template <typename Number>
  class ShapeAtPoint
  {
  public:
    /// Takes F and its change dF along a direction.
    ShapeAtPoint(const bool has_rotations, const Matrix3<Number> &F, const Matrix3<Number> &dF)
        : ShapeAtPoint(
            has_rotations, has_rotations ? closest_rotation(F) : identity_matrix<Number>(), F, dF)
    {
    }

    /// The same with the rotation R of F.
    ShapeAtPoint(const bool             has_rotations,
                 const Matrix3<Number> &R,
                 const Matrix3<Number> &F,
                 const Matrix3<Number> &dF)
        : has_rotations(has_rotations), R(R), turn{}, gradient{ F, dF }, shape(gradient)
    {
      if (!has_rotations)
        return;
      shape.value             = symmetric_part(transpose_times(R, F));
      const Matrix3<Number> M = transpose_times(R, dF);
      // Eq. (18): the equation of W with M in the place of the products
      Matrix3<Number> B = combine(Number(-1.), shape.value, Number(0.), shape.value), skew;
      for (int i = 0; i < 3; ++i)
      {
        B[i][i] += trace(shape.value);
        for (int j = 0; j < 3; ++j)
          skew[i][j] = M[i][j] - M[j][i];
      }
      turn         = skew_matrix(inverse_of_symmetric(B) * axial_vector(skew));
      shape.change = symmetric_part(combine(Number(1.), M, Number(-1.), turn * shape.value));
    }

    /// F and its change.
    const ChangingMatrix<Number> &
    get_gradient() const
    {
      return gradient;
    }

    /// The matrix S, or F, and its change.
    const ChangingMatrix<Number> &
    get() const
    {
      return shape;
    }

    /// Derivatives by F and dF of the slope of a potential with this R^T P.
    ShapeDerivatives<Number>
    derivatives(const ChangingMatrix<Number> &of) const
    {
      if (!has_rotations)
        return { of.change, of.value };
      return { R * combine(Number(1.), turn * of.value, Number(1.), of.change), R * of.value };
    }

  private:
    bool                   has_rotations;
    Matrix3<Number>        R, turn; ///< R and R^T dR
    ChangingMatrix<Number> gradient, shape;
  };

  using PointShape = ShapeAtPoint<double>;
} // namespace Exemplar

#endif
