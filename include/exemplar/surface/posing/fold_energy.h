// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fold_energy_h
#define exemplar_fold_energy_h

#include <exemplar/kernels/matrix3.h>

#include <array>

// An energy of deformation gradients that is finite for inverted cells as long as it is
// regularised, and grows without bounds for them as the regularisation goes to zero
// (V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov: Foldover-free maps
// in 50 lines of code. ACM Transactions on Graphics 40(4), 2021).

namespace Exemplar
{
  /// f = |F|^2 / chi^(2/3) + (det(F)^2 + 1) / chi - 5 with chi = (det F + sqrt(eps^2 + det(F)^2)) /
  /// 2, Eqs. (3) to (5) there. Not negative for eps = 0, where it is zero for rotations alone and
  /// infinite for det F <= 0.
  double
  fold_energy(const Matrix3<double> &F, double eps);

  /// The derivative of fold_energy() by F (first Piola-Kirchhoff stress), for a finite energy.
  Matrix3<double>
  fold_stress(const Matrix3<double> &F, double eps);

  /// The second derivative by F as sum_m stiffness_m direction_m (x) direction_m, in orthonormal
  /// directions. They are those of any isotropic energy (Smith, de Goes, Kim 2019: Analytic
  /// eigensystems for isotropic distortion energies): with F = U diag(s) V^T three turns, three
  /// shears, and combinations of the stretches u_i v_i^T.
  struct FoldModes
  {
    std::array<double, 9>          stiffness;
    std::array<Matrix3<double>, 9> direction;
  };

  FoldModes
  fold_modes(const Matrix3<double> &F, double eps);
} // namespace Exemplar

#endif
