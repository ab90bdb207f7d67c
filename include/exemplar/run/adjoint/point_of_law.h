// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_of_law_h
#define exemplar_point_of_law_h

#include <exemplar/kernels/patch_cell.h>
#include <exemplar/run/adjoint/laws_with_derivatives.h>
#include <exemplar/run/adjoint/patch_potential.h>

#include <deal.II/base/array_view.h>

// Where the potential of a point is taken, and what its energies have in common.

namespace Exemplar
{
  /// What is the same at all points.
  struct PointScene
  {
    ExampleConstants examples;
    double           blended_part; ///< of the blended energy
    /// What patches take of the volume part of the elasticity and of the guard (24): all, or nothing, 0.
    double part_of_patches;
  };

  /// Where the potential of a point is taken.
  template <typename Number>
  struct PointPlace
  {
    Matrix3<Number>           shape; ///< as its law sees F: PointShape
    Matrix3<Number>           wish;  ///< the strain that it is drawn to, before a part of it acts
    MaterialFunctions<Number> material;
    Number                    importance; ///< eta of all cells
  };

  /// The derivatives of a patch's potential by its sums, and how they change.
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

  /// Those of the patches that a point belongs to: one, or none.
  using FactorsAtPoint = dealii::ArrayView<const PatchFactors>;

  template <typename Number>
  Number
  constant(const HyperDual<0> &number)
  {
    return Number(number.value, number.change);
  }

  /// A cell with its law, and what its patch sums up of it.
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
    /// The derivative by p_0 of Eq. (16) of an energy with this target.
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

    /// With this trace of what the point is drawn to.
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

    /// Whether no guard acts, and forces are those of the law.
    bool
    is_regular() const
    {
      if constexpr (Cell::traits.has_guard)
        return !cell.is_guarded() && !may_be_thin();
      return true;
    }

    /// Of the energy with this target.
    PointStress<Number>
    stress_towards(const Matrix3<Number> &D)
    {
      cell.set_target(D);
      return { cell.force(), times(Number(-1.), cell.weight_stress(D)) };
    }

    /// Of the traces in a patch with these factors, by the shape and the target.
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
