// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_slope_h
#define exemplar_point_slope_h

#include <exemplar/run/adjoint/point_numbers.h>
#include <exemplar/run/adjoint/point_potential.h>

// The contribution of a point to the slope.

namespace Exemplar
{
  /// The strain in a point's target, and its change along the direction.
  struct Wish
  {
    Matrix3<double> value, change;
  };

  /// The derivatives of a slope by a wish are the changes of the potential's derivatives.
  inline Wish
  slope_by_wish(const Matrix3<HyperDual<0>> &by_wish)
  {
    using Number = HyperDual<0>;
    return { OfPoint::parts_of<double>(by_wish, [](const Number &x) { return x.change; }),
             OfPoint::parts_of<double>(by_wish, [](const Number &x) { return x.value; }) };
  }

  /// The contribution of a point to the slope, per volume, and its derivatives.
  struct PointSlope
  {
    double                    slope;
    PointStress<HyperDual<0>> stress;
    OfPoint::Constants        by_constants;
    double                    by_guard_bound; ///< derivative by p_0 of Eq. (16)
  };

  /// Slope of a point where the law gives the forces.
  inline PointSlope
  slope_of_stress(const PointShape                     &shape,
                  const Wish                           &wish,
                  const RegularPoint<OfPoint::Regular> &found)
  {
    using Number         = OfPoint::Regular;
    const auto &by_shape = found.stress.by_shape;
    const auto &by_wish  = found.stress.by_wish;
    const auto  along    = [&](const auto &part)
    {
      return contract(OfPoint::parts_of<double>(by_shape, part), shape.get_change())
             + contract(OfPoint::parts_of<double>(by_wish, part), wish.change)
             + part(found.of_patches);
    };
    PointSlope result{ along([](const Number &number) { return number.value; }),
                       { OfPoint::changing(by_shape), OfPoint::changing(by_wish) },
                       {},
                       0. };
    for (std::size_t k = 0; k < OfPoint::n_constants; ++k)
      result.by_constants[k] = along([k](const Number &number) { return number.by[1 + k]; });
    return result;
  }
} // namespace Exemplar

#endif
