// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_slope_h
#define exemplar_point_slope_h

#include <exemplar/run/adjoint/point_shape.h>
#include <exemplar/run/adjoint/point_stress.h>

// The contribution of a point to the slope.

namespace Exemplar
{
  /// The matrix of part(number) of each entry.
  template <typename Number, typename Part>
  Matrix3<double>
  parts_of(const Matrix3<Number> &A, const Part &part)
  {
    Matrix3<double> result;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        result[i][j] = part(A[i][j]);
    return result;
  }

  /// A matrix of numbers as values with their changes along the direction.
  template <typename Number>
  MatrixAlong
  values_along(const Matrix3<Number> &A)
  {
    return { parts_of(A, [](const Number &number) { return number.value; }),
             parts_of(A, [](const Number &number) { return number.by[0]; }) };
  }

  /// A matrix that changes along the direction.
  template <typename Number>
  Matrix3<Number>
  changing(const MatrixAlong &A)
  {
    Matrix3<Number> result;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        result[i][j] = Number(A.value[i][j], A.change[i][j]);
    return result;
  }

  /// The derivatives of a slope by what belongs to a point, per volume.
  struct PointSlope
  {
    double                                   by_volume = 0.;
    MatrixAlong                              by_shape, by_wish; ///< of the potential
    std::array<double, OfPoint::n_constants> by_constants{};    ///< E, nu, eta and p_0
  };

  /// Call function(point) with the Evaluation, ElasticPoint or DampingPoint, at a place.
  template <template <typename, typename> class Evaluation, typename Number, typename Function>
  void
  with_point(const PointPlace<Number> &at, const Function &function)
  {
    with_potential<Number>(at.law, [&](auto model)
                           { function(Evaluation<typename decltype(model)::type, Number>(at)); });
  }

  /// The stress of an Evaluation, with the terms of its patch, if it has one.
  template <template <typename, typename> class Evaluation, typename Number>
  PointStress<Number>
  stress_at(const PointPlace<Number> &at, const PatchFactors *factors)
  {
    PointStress<Number> found;
    with_point<Evaluation>(at, [&](auto &&point) { found = point.stress(factors); });
    return found;
  }

  /// What part(number) of a stress does along changes of the shape and the wish.
  template <typename Number, typename Part>
  double
  work_along(const PointStress<Number> &stress,
             const Matrix3<double>     &of_shape,
             const Matrix3<double>     &of_wish,
             const Part                &part)
  {
    return contract(parts_of(stress.by_shape, part), of_shape)
           + contract(parts_of(stress.by_wish, part), of_wish);
  }

  /// The derivatives of a slope through an Evaluation whose shape and wish change like this.
  template <template <typename, typename> class Evaluation, typename Number>
  PointSlope
  slope_at(const PointPlace<Number> &at,
           const Matrix3<double>    &of_shape,
           const Matrix3<double>    &of_wish,
           const PatchFactors       *factors)
  {
    const PointStress<Number> found    = stress_at<Evaluation>(at, factors);
    const auto                slope_of = [&](const auto &part)
    { return work_along(found, of_shape, of_wish, part) + part(found.of_patch); };
    PointSlope result{ slope_of([](const Number &number) { return number.value; }),
                       values_along(found.by_shape), values_along(found.by_wish) };
    for (std::size_t k = 1; k < Number::n_derivatives; ++k)
      result.by_constants[k - 1] = slope_of([k](const Number &number) { return number.by[k]; });
    return result;
  }

  /// The point's integrands in the sums of its patch.
  template <template <typename, typename> class Evaluation>
  PatchFactors
  patch_sums(const PointPlace<OfPoint::Changing> &at)
  {
    PatchFactors sums;
    with_point<Evaluation>(at, [&](auto &&point) { sums = point.of_patch(); });
    return sums;
  }
} // namespace Exemplar

#endif
