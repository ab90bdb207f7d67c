// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/obstacle.h>
#include <exemplar/potential/pair_slip.h>

#include <cmath>

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

    PairPoints
    centred(PairPoints points)
    {
      const SpaceVector3 centre = 0.25 * (points[0] + points[1] + points[2] + points[3]);
      for (SpaceVector3 &point : points)
        point -= centre;
      return points;
    }

    /// Whether a symmetric matrix with this added to its diagonal is definite, clearly for entries of this size.
    bool
    is_definite(const dealii::Tensor<2, 3> &matrix, const double diagonal, const double size)
    {
      constexpr double     clearly = 1e-12;
      dealii::Tensor<2, 3> sum     = matrix;
      for (unsigned int c = 0; c < 3; ++c)
        sum[c][c] += diagonal;
      return sum[0][0] > 0. && sum[0][0] * sum[1][1] - sum[0][1] * sum[1][0] > 0.
             && dealii::determinant(sum) > clearly * size * size * size;
    }

    SpaceVector3
    weighted_sum(const PairPoints &points, const std::array<double, 4> &coefficients)
    {
      SpaceVector3 sum;
      for (unsigned int i = 0; i < 4; ++i)
        sum += coefficients[i] * points[i];
      return sum;
    }
  } // namespace

  std::optional<PairMotion>
  PairMotion::from(const PairPoints            &before,
                   const PairPoints            &now,
                   const std::array<double, 4> &coefficients)
  {
    constexpr unsigned int max_turns    = 200;
    constexpr double       part_of_size = 0.1, longest = 1.; ///< [rad]
    constexpr double       small = 1e-8; ///< [rad]: the next turn, its square, is rounding
    const PairPoints       there = centred(now), here = centred(before);
    double                 size = 0.;
    for (unsigned int i = 0; i < 4; ++i)
      size += here[i].norm() * there[i].norm();
    double     last = 1.; // turn [rad]
    PairMotion result;
    result.coefficients     = coefficients;
    result.of_points        = weighted_sum(there, coefficients);
    result.of_points_before = weighted_sum(here, coefficients);
    for (unsigned int c = 0; c < 3; ++c)
      result.rotation[c][c] = 1.;
    for (unsigned int turn = 0; turn < max_turns; ++turn)
    {
      dealii::Tensor<2, 3> products; // sum of arm x point, which is symmetric in the end
      SpaceVector3         moment;
      for (unsigned int i = 0; i < 4; ++i)
      {
        result.arms[i] = result.rotation * here[i];
        products += dealii::outer_product(result.arms[i], there[i]);
        moment += dealii::cross_product_3d(result.arms[i], there[i]);
      }
      dealii::Tensor<2, 3> matrix   = -0.5 * (products + dealii::transpose(products));
      const double         trace    = dealii::trace(products);
      const bool           is_final = is_definite(matrix, trace, size);
      // a turn from far away goes up the slope with a matrix that is definite
      const double diagonal = is_final ? trace : matrix.norm() + part_of_size * size;
      for (unsigned int c = 0; c < 3; ++c)
        matrix[c][c] += diagonal;
      result.turn_by_moment = dealii::invert(matrix);
      SpaceVector3 rotation = result.turn_by_moment * moment;
      if (last < small)
        return is_final ? std::optional(result) : std::nullopt;
      last = rotation.norm();
      if (last > longest)
        rotation *= longest / last;
      result.rotation = rotation_by(rotation) * result.rotation;
    }
    return {};
  }

  dealii::Tensor<2, 3>
  PairMotion::by_point(const unsigned int i) const
  {
    // the axes turn by turn_by_moment * (arm_i x dx_i), and r stays behind them
    dealii::Tensor<2, 3> result = cross_matrix(of_points) * turn_by_moment * cross_matrix(arms[i]);
    for (unsigned int c = 0; c < 3; ++c)
      result[c][c] += coefficients[i];
    return result;
  }
} // namespace Exemplar
