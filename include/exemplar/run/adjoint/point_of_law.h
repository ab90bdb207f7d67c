// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_of_law_h
#define exemplar_point_of_law_h

#include <exemplar/kernels/patch_cell.h>
#include <exemplar/run/adjoint/laws_with_derivatives.h>
#include <exemplar/run/adjoint/patch_potential.h>

#include <deal.II/base/array_view.h>

// The variables of a point's potential, and the base of its energies.

namespace Exemplar
{
  /// Settings that all points share.
  struct PointScene
  {
    ExampleConstants examples;
    double           blended_part; ///< share of the blended energy
    /// 1 if patches take the volume part of the elasticity and the guard (24), else 0.
    double part_of_patches;
  };

  /// The variables at a point.
  template <typename Number>
  struct PointPlace
  {
    Matrix3<Number>           shape; ///< S or F, as the law needs it: see PointShape
    Matrix3<Number>           wish;  ///< the blend of the examples' strains, before Eq. (31)
    MaterialFunctions<Number> material;
    Number                    importance; ///< eta of all cells
  };

  /// The derivatives of a patch's potential by its sums, with their changes along the direction.
  using PatchFactors = PatchSums<HyperDual<0>>;

  /// The derivatives of a potential by the shape, as R^T P, and by the wish or the target.
  template <typename Number>
  struct PointStress
  {
    PointStress &
    operator+=(const PointStress &other)
    {
      by_shape = combine(Number(1.), by_shape, Number(1.), other.by_shape);
      by_wish  = combine(Number(1.), by_wish, Number(1.), other.by_wish);
      return *this;
    }

    PointStress
    scaled(const Number &factor) const
    {
      return { times(factor, by_shape), times(factor, by_wish) };
    }

    Matrix3<Number> by_shape, by_wish;
  };

  /// The factors of the point's patch; empty without patches.
  using FactorsAtPoint = dealii::ArrayView<const PatchFactors>;

  template <typename Number>
  Number
  constant(const HyperDual<0> &number)
  {
    return Number(number.value, number.change);
  }

  /// A cell with its law, and its integrands in the sums of its patch.
  template <typename Cell, typename Number>
  class PointOfLaw
  {
  public:
    PointOfLaw(const CellLaw law, const PointScene &scene, const PointPlace<Number> &at)
        : scene(scene), at(at), cell(at.material.template of_law<typename Cell::Constants>(law),
                                     identity_matrix<Number>(),
                                     at.shape,
                                     scene.examples)
    {
    }

  protected:
    /// The derivative by p_0 of Eq. (16) of an energy with the target D.
    Number
    energy_by_guard_bound(const Matrix3<Number> &D) const
    {
      if constexpr (Cell::traits.has_guard)
        if (cell.is_guarded())
        {
          const Number p_0 = Number(scene.examples.guard_bound), p = cell.product_of_sums();
          return guard_energy(cell.own_material(), Number(1.), cell.stretch_factor(), D)
                 * guard(p, p_0).derivative * p / p_0;
        }
      return Number(0.);
    }

    /// The sums of the dilatation, where `wish` is the trace of the target.
    PatchSums<Number>
    dilatation(const Number &wish) const
    {
      PatchSums<Number> sums;
      sums[PatchSum::volume] = Number(1.);
      sums[PatchSum::lambda] = at.material.lambda_of_patches();
      sums[PatchSum::trace]  = trace(cell.strain());
      sums[PatchSum::wish]   = wish;
      if constexpr (Cell::traits.has_guard_of_patches())
        if (may_be_thin())
          sums[PatchSum::trace]
              += supplement(ThinTrace<Number>(cell.stretch_factor(), cell.product_of_sums()));
      return sums;
    }

    static Number
    supplement(const ThinTrace<Number> &thin)
    {
      return thin.acts() ? thin.supplement() : Number(0.);
    }

    bool
    may_be_thin() const
    {
      return StretchGuard<Number>::may_act(cell.stretch_factor(), cell.product_of_sums());
    }

    /// Whether no guard acts, so that the law gives the forces.
    bool
    is_regular() const
    {
      if constexpr (Cell::traits.has_guard)
        return !cell.is_guarded() && !may_be_thin();
      return true;
    }

    /// The derivatives of the law's energy with the target D.
    PointStress<Number>
    stress_towards(const Matrix3<Number> &D)
    {
      cell.set_target(D);
      return { cell.force(), times(Number(-1.), cell.weight_stress(D)) };
    }

    /// The derivatives of the terms in traces of a patch with these factors.
    PointStress<Number>
    stress_of_traces(const PatchFactors &factors) const
    {
      const Matrix3<Number> I = identity_matrix<Number>();
      const Number          pressure
          = constant<Number>(factors[PatchSum::trace])
            + Number(2.) * trace(cell.strain()) * constant<Number>(factors[PatchSum::trace_square]);
      return { times(pressure, I), times(constant<Number>(factors[PatchSum::wish]), I) };
    }

    const PointScene         &scene;
    const PointPlace<Number> &at;
    Cell                      cell;
  };
} // namespace Exemplar

#endif
