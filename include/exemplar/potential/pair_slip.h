// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pair_slip_h
#define exemplar_pair_slip_h

#include <exemplar/obstacles/closest_features.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// The four points of a pair of parts of a body [m].
  using PairPoints = std::array<SpaceVector3, 4>;

  /// The matrices B_i of the slip u = sum B_i dx_i of a pair, of which the one part moves along the other by sum c_i dx_i, with
  /// coefficients whose sum is 0. The slip is that motion, less the turn of the points about their centre times the lever
  /// r = sum c_i x_i. So it is 0 where the pair turns as a whole, and forces B_i^T f have neither a sum nor a moment, whatever
  /// their lever. Empty where points in one line leave the turn open.
  std::vector<dealii::Tensor<2, 3>>
  slip_of_pair(const PairPoints &points, const std::array<double, 4> &coefficients);
} // namespace Exemplar

#endif
