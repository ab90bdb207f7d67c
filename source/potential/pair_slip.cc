// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/pair_slip.h>

namespace Exemplar
{
  namespace
  {
    /// The matrix of v -> a x v.
    dealii::Tensor<2, 3>
    cross_matrix(const SpaceVector3 &a)
    {
      dealii::Tensor<2, 3> result;
      result[0][1] = -a[2];
      result[0][2] = a[1];
      result[1][0] = a[2];
      result[1][2] = -a[0];
      result[2][0] = -a[1];
      result[2][1] = a[0];
      return result;
    }
  } // namespace

  std::vector<dealii::Tensor<2, 3>>
  slip_of_pair(const PairPoints &points, const std::array<double, 4> &coefficients)
  {
    constexpr double   one_line = 1e-12; ///< of the determinant of inertia over its greatest value
    const SpaceVector3 centre   = 0.25 * (points[0] + points[1] + points[2] + points[3]);
    SpaceVector3       lever;
    dealii::Tensor<2, 3> inertia;
    for (unsigned int i = 0; i < 4; ++i)
    {
      const SpaceVector3 arm = points[i] - centre;
      lever += coefficients[i] * points[i];
      inertia -= dealii::outer_product(arm, arm);
      for (unsigned int c = 0; c < 3; ++c)
        inertia[c][c] += arm * arm;
    }
    const double size = dealii::trace(inertia);
    if (!(dealii::determinant(inertia) > one_line * size * size * size))
      return {};
    const dealii::Tensor<2, 3>        turn = cross_matrix(lever) * dealii::invert(inertia);
    std::vector<dealii::Tensor<2, 3>> result(4);
    for (unsigned int i = 0; i < 4; ++i)
    {
      result[i] = turn * cross_matrix(points[i] - centre);
      for (unsigned int c = 0; c < 3; ++c)
        result[i][c][c] += coefficients[i];
    }
    return result;
  }
} // namespace Exemplar
