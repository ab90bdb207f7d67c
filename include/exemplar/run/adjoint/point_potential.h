// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_potential_h
#define exemplar_point_potential_h

#include <exemplar/kernels/patch_cell.h>
#include <exemplar/run/adjoint/laws_with_derivatives.h>
#include <exemplar/run/adjoint/patch_potential.h>

#include <deal.II/base/array_view.h>

// The potential of a point as one function of all that it depends on, for numbers that carry derivatives.

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
    Matrix3<double>           R; ///< the rotation of the value of F
    Matrix3<Number>           F;
    Matrix3<Number>           wish; ///< the strain that it is drawn to, before a part of it acts
    MaterialFunctions<Number> material;
    Number                    importance; ///< eta of all cells
  };

  /// The derivatives of a patch's potential by its sums, and how they change.
  using PatchFactors = PatchSums<HyperDual<0>>;

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
                                     rotation(),
                                     at.F,
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

    const PointScene         &scene;
    const PointPlace<Number> &at;

  private:
    Matrix3<Number>
    rotation() const
    {
      if constexpr (Cell::traits.has_rotations)
        return rotation_by_F(at.R, at.F);
      return identity_matrix<Number>();
    }

  protected:
    const Cell cell;
  };

  /// The elastic energy, with examples.
  template <typename Cell, typename Number>
  class ElasticPoint : public PointOfLaw<Cell, Number>
  {
    using Base = PointOfLaw<Cell, Number>;
    using Base::at;
    using Base::cell;
    using Base::scene;

  public:
    ElasticPoint(const CellLaw law, const PointScene &scene, const PointPlace<Number> &at)
        : Base(law, scene, at), D(at.material.target(at.wish))
    {
    }

    Number
    energy() const
    {
      return cell.energy(D) + of_share() + of_guard() + form_of_weights();
    }

    Number
    by_guard_bound() const
    {
      return this->energy_by_guard_bound(D);
    }

    PatchSums<Number>
    of_patch() const
    {
      PatchSums<Number> sums     = this->dilatation(trace(D));
      sums[PatchSum::square]     = contract(at.F, at.F);
      sums[PatchSum::importance] = at.material.importance();
      if (at.material.has_own_examples())
        sums[PatchSum::excess] = at.material.excess(D).lambda_of_patches;
      if constexpr (Cell::traits.has_guard_of_patches())
        if (this->may_be_thin()) // hardly ever
          sums[PatchSum::guard] = guard_of_patch();
      if constexpr (Cell::traits.knows_volume)
        sums[PatchSum::volume_change] = volume_change(cell.strain());
      sums[PatchSum::trace_square] = sums[PatchSum::trace] * sums[PatchSum::trace];
      return sums;
    }

  private:
    Number
    of_cells() const
    {
      return Number(1. - scene.part_of_patches);
    }

    /// A law that knows eta has it as a number without derivatives.
    Number
    of_share() const
    {
      Number sum(0.);
      if constexpr (Cell::traits.knows_volume)
      {
        const Number change = at.importance - Number(scene.examples.importance);
        const Number of_strain
            = Number(0.5) * contract(stress(cell.own_material(), cell.strain()), cell.strain());
        sum += change * (of_strain - cell.elastic_density());
        if (cell.is_stretched()) // whose energy is proportional to eta
          sum += of_cells() * change / at.importance * cell.stretch().energy();
      }
      return sum;
    }

    /// Eq. (24).
    Number
    of_guard() const
    {
      if constexpr (Cell::traits.has_guard)
        if (cell.is_stretched())
          return of_cells() * cell.stretch().energy();
      return Number(0.);
    }

    /// What the weights' form has beyond the Gram matrix of the targets.
    Number
    form_of_weights() const
    {
      const Number &eta  = at.material.importance();
      const Number  half = Number(0.5 * scene.blended_part);
      if (at.material.has_own_examples())
        return half * at.material.excess(D).energy;
      if (eta > Number(0.))
        return half * (Number(1.) - eta) / eta * contract(stress(cell.own_material(), D), D);
      return Number(0.);
    }

    Number
    guard_of_patch() const
    {
      const Number               share = Cell::traits.knows_volume ? at.importance : Number(1.);
      const StretchGuard<Number> guard(at.material.isotropic_part().scaled(share),
                                       cell.stretch_factor(), cell.product_of_sums());
      return guard.acts() ? guard.energy() : Number(0.);
    }

    const Matrix3<Number> D;
  };

  /// The energy of stiffness damping, Eq. (22), with s = 1. The wish is the strain that is compared.
  template <typename Cell, typename Number>
  class DampingPoint : public PointOfLaw<Cell, Number>
  {
    using Base = PointOfLaw<Cell, Number>;
    using Base::at;
    using Base::cell;

  public:
    using Base::Base;

    Number
    energy() const
    {
      return cell.damping_density(at.wish);
    }

    Number
    by_guard_bound() const
    {
      return this->energy_by_guard_bound(at.wish);
    }

    PatchSums<Number>
    of_patch() const
    {
      return this->dilatation(trace(at.wish)
                              + this->supplement(ThinTrace<Number>::of_strain(at.wish)));
    }
  };

  /// Over the volume, with what its patches make of it.
  template <typename Number>
  struct PointPotential
  {
    Number potential;
    Number by_guard_bound; ///< derivative by p_0 of Eq. (16)
  };

  /// Of one of the evaluations above, `share` times.
  template <template <typename, typename> class Evaluation, typename Number>
  PointPotential<Number>
  point_potential(const CellLaw             law,
                  const PointScene         &scene,
                  const PointPlace<Number> &at,
                  const double              share,
                  const FactorsAtPoint     &of_patches)
  {
    PointPotential<Number> found;
    with_potential<Number>(
        law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          const Evaluation<Cell, Number> point(law, scene, at);
          found = { Number(share) * point.energy(), Number(share) * point.by_guard_bound() };
          if constexpr (Cell::traits.trace_gradient_is_R) // others have no patches
            for (const PatchFactors &factor : of_patches)
            {
              const PatchSums<Number> sums = point.of_patch();
              for (std::size_t k = 0; k < PatchFactors::size; ++k)
                found.potential += constant<Number>(factor.numbers[k]) * sums.numbers[k];
            }
        });
    return found;
  }

  /// What the patch of the point sums up.
  template <template <typename, typename> class Evaluation, typename Number>
  PatchSums<Number>
  patch_sums(const CellLaw law, const PointScene &scene, const PointPlace<Number> &at)
  {
    PatchSums<Number> sums;
    with_potential<Number>(law,
                           [&](auto model)
                           {
                             using Cell = typename decltype(model)::type;
                             if constexpr (Cell::traits.trace_gradient_is_R)
                               sums = Evaluation<Cell, Number>(law, scene, at).of_patch();
                           });
    return sums;
  }
} // namespace Exemplar

#endif
