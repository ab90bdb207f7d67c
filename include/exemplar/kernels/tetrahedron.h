// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tetrahedron_h
#define exemplar_tetrahedron_h

#include <exemplar/kernels/elasticity.h>
#include <exemplar/kernels/matrix3.h>

// The corotational model of one linear tetrahedron, as pure functions. Equation
// numbers are those of doc/method.md. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// What the kernels know of a cell at rest.
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

  /// sym(R^T F) - I, Eq. (2). It is the corotated (Biot) strain S - I if R is the
  /// rotation of F, and the strain that frozen rotations see otherwise.
  template <typename Number>
  Matrix3<Number>
  corotated_strain(const Matrix3<Number> &rotation, const Matrix3<Number> &deformation_gradient)
  {
    Matrix3<Number> strain = symmetric_part(transpose_times(rotation, deformation_gradient));
    for (int i = 0; i < 3; ++i)
      strain[i][i] -= Number(1.);
    return strain;
  }

  /// C:E = lambda tr(E) I + 2 mu E, Eq. (3) [Pa].
  template <typename Number>
  Matrix3<Number>
  stress(const CellMaterial<Number> &lame, const Matrix3<Number> &strain)
  {
    const Number    pressure = lame.lambda * trace(strain);
    Matrix3<Number> T;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        T[i][j] = Number(2.) * lame.mu * strain[i][j] + (i == j ? pressure : Number(0.));
    return T;
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

  /// The gradients R g_a. An isotropic stiffness is turned by turning these four
  /// vectors; the 12x12 matrix itself is never multiplied.
  template <typename Number>
  void
  rotate_gradients(const Tetrahedron<Number> &cell,
                   const Matrix3<Number>     &rotation,
                   Vector3<Number> (&rotated)[4])
  {
    for (int a = 0; a < 4; ++a)
      rotated[a] = rotation * cell.shape_gradient[a];
  }

  /// Block (a,b) of R K R^T, Eq. (8):
  /// V (lambda g_a g_b^T + mu (g_b g_a^T + (g_a.g_b) I)) with rotated gradients [N/m].
  template <typename Number>
  Matrix3<Number>
  stiffness_block(const CellMaterial<Number> &lame,
                  const Number               &volume,
                  const Vector3<Number>      &g_a,
                  const Vector3<Number>      &g_b)
  {
    const Number    lambda = lame.lambda * volume, mu = lame.mu * volume;
    const Number    diagonal = mu * dot(g_a, g_b);
    Matrix3<Number> K;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        K[i][j]
            = lambda * g_a[i] * g_b[j] + mu * g_b[i] * g_a[j] + (i == j ? diagonal : Number(0.));
    return K;
  }
} // namespace Exemplar

#endif
