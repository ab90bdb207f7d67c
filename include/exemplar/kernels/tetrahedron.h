// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tetrahedron_h
#define exemplar_tetrahedron_h

#include <exemplar/kernels/matrix3.h>

// The geometry of one linear tetrahedron and the forces at its nodes, as pure functions. Equation
// numbers are those of doc/method.md. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A cell at rest.
  template <typename Number>
  struct Tetrahedron
  {
    Vector3<Number> shape_gradient[4]; ///< g_a, gradient of shape function a [1/m]
    Number          volume;            ///< V [m^3]
  };

  /// F = sum_a x_a (x) g_a, Eq. (1).
  template <typename Number>
  Matrix3<Number>
  deformation_gradient(const Tetrahedron<Number> &cell, const Vector3<Number> (&position)[4])
  {
    Matrix3<Number> F;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        F[i][j] = position[0][i] * cell.shape_gradient[0][j]
                  + position[1][i] * cell.shape_gradient[1][j]
                  + position[2][i] * cell.shape_gradient[2][j]
                  + position[3][i] * cell.shape_gradient[3][j];
    return F;
  }

  /// sym(R^T F) - I, Eq. (2). If R is the rotation of F, this is the corotated (Biot) strain
  /// S - I; if R is a rotation that is held fixed, it is the strain of which frozen forces are the
  /// derivative.
  template <typename Number>
  Matrix3<Number>
  corotated_strain(const Matrix3<Number> &rotation, const Matrix3<Number> &deformation_gradient)
  {
    Matrix3<Number> strain = symmetric_part(transpose_times(rotation, deformation_gradient));
    for (int i = 0; i < 3; ++i)
      strain[i][i] -= Number(1.);
    return strain;
  }

  /// Nodal forces V R T g_a of a cell whose rotation is frozen, Eq. (6) [N].
  template <typename Number>
  void
  frozen_forces(const Tetrahedron<Number> &cell,
                const Matrix3<Number>     &rotation,
                const Matrix3<Number>     &corotated_stress,
                Vector3<Number> (&force)[4])
  {
    const Matrix3<Number> P = rotation * corotated_stress;
    for (int a = 0; a < 4; ++a)
    {
      force[a] = P * cell.shape_gradient[a];
      for (int i = 0; i < 3; ++i)
        force[a][i] *= cell.volume;
    }
  }

  /// The gradients R g_a.
  template <typename Number>
  void
  rotate_gradients(const Tetrahedron<Number> &cell,
                   const Matrix3<Number>     &rotation,
                   Vector3<Number> (&rotated)[4])
  {
    for (int a = 0; a < 4; ++a)
      rotated[a] = rotation * cell.shape_gradient[a];
  }
} // namespace Exemplar

#endif
