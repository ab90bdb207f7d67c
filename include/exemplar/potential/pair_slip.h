// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pair_slip_h
#define exemplar_pair_slip_h

#include <exemplar/obstacles/closest_features.h>

#include <array>
#include <optional>

namespace Exemplar
{
  /// The four points of a pair of parts of a body [m].
  using PairPoints = std::array<SpaceVector3, 4>;

  /// A motion r = sum c_i x_i of two points of a pair along each other, with coefficients whose sum is 0, seen from axes that turn with
  /// the pair: the rotation R fits the points now best to those before. So the motion u = r - R r_before of a pair that turns as a
  /// whole is 0, and forces that are the derivative of a function of R^T u have neither a sum nor a moment, whatever their lever.
  class PairMotion
  {
  public:
    /// Empty where points in one line leave the rotation open.
    static std::optional<PairMotion>
    from(const PairPoints            &before,
         const PairPoints            &now,
         const std::array<double, 4> &coefficients);

    /// u [m].
    SpaceVector3
    motion() const
    {
      return of_points - rotation * of_points_before;
    }

    /// du/dx_i in these axes.
    dealii::Tensor<2, 3>
    by_point(unsigned int i) const;

    dealii::Tensor<2, 3> rotation; ///< R

  private:
    PairMotion() = default;

    SpaceVector3          of_points, of_points_before; ///< r
    PairPoints            arms;                        ///< points before from their centre, turned
    dealii::Tensor<2, 3>  turn_by_moment; ///< the turn [rad] for a sum of arms times displacements
    std::array<double, 4> coefficients;
  };
} // namespace Exemplar

#endif
