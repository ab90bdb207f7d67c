// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tetrahedron_h
#define exemplar_tetrahedron_h

#include <exemplar/kernels/element.h>
#include <exemplar/kernels/matrix3.h>

// The geometry of a tetrahedron at a point and the forces at its nodes, as pure functions. Equation
// numbers are those of doc/method.md. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A quadrature point of a cell at rest.
  template <typename Number, int n_nodes = 4>
  struct Tetrahedron
  {
    Vector3<Number> shape_gradient[n_nodes]; ///< g_a, gradient of shape function a [1/m]
    Number          volume;                  ///< V, quadrature weight
  };

  /// The deformation gradient F = sum_a x_a (x) g_a, Eq. (1).
  template <typename Number, int n_nodes>
  Matrix3<Number>
  deformation_gradient(const Tetrahedron<Number, n_nodes> &cell,
                       const Vector3<Number> (&position)[n_nodes])
  {
    Matrix3<Number> F;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        F[i][j] = position[0][i] * cell.shape_gradient[0][j];
        for (int a = 1; a < n_nodes; ++a)
          F[i][j] += position[a][i] * cell.shape_gradient[a][j];
      }
    return F;
  }

  /// The corotated strain sym(R^T F) - I, Eq. (2). If R is the rotation of F, this is the Biot
  /// strain S - I; if R is held fixed, it is the strain whose energy has the frozen forces as its
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
  template <typename Number, int n_nodes>
  void
  frozen_forces(const Tetrahedron<Number, n_nodes> &cell,
                const Matrix3<Number>              &rotation,
                const Matrix3<Number>              &corotated_stress,
                Vector3<Number> (&force)[n_nodes])
  {
    const Matrix3<Number> P = rotation * corotated_stress;
    for (int a = 0; a < n_nodes; ++a)
    {
      force[a] = P * cell.shape_gradient[a];
      for (int i = 0; i < 3; ++i)
        force[a][i] *= cell.volume;
    }
  }

  /// The rotated shape gradients R g_a.
  template <typename Number, int n_nodes>
  void
  rotate_gradients(const Tetrahedron<Number, n_nodes> &cell,
                   const Matrix3<Number>              &rotation,
                   Vector3<Number> (&rotated)[n_nodes])
  {
    for (int a = 0; a < n_nodes; ++a)
      rotated[a] = rotation * cell.shape_gradient[a];
  }
} // namespace Exemplar

#endif
