// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_gap_h
#define exemplar_gap_h

#include <deal.II/base/tensor.h>

#include <array>

namespace Exemplar
{
  /// A gap between the body and what it may not pass: distance d > 0 [m] of a point sum c_i x_{n_i} (or of a pair)
  /// and its gradient along `normal`: that by x_{n_i} is c_i * normal. Its barrier's energy is that of
  /// Barrier{stiffness, width}.
  struct Gap
  {
    unsigned int                n_nodes = 0;
    std::array<unsigned int, 4> nodes{};
    std::array<double, 4>       coefficients{};
    dealii::Tensor<1, 3>        normal;
    double                      distance  = 0.; ///< [m]
    double                      stiffness = 0.; ///< k [N]
    double                      width     = 0.; ///< d_hat [m]
  };
} // namespace Exemplar

#endif
