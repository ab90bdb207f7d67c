// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_potential_h
#define exemplar_point_potential_h

#include <exemplar/run/adjoint/point_of_law.h>

#include <optional>

// The potential of a point as one function of all its variables, for numbers that carry
// derivatives.

namespace Exemplar
{
  /// The elastic energy density, with examples.
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

    /// The derivatives of `share` times the energy, patch terms included, by the law's own force;
    /// nothing if a guard acts or the target is not eta times the wish.
    std::optional<PointStress<Number>>
    regular_stress(const double share, const FactorsAtPoint &of_patches)
    {
      if (!this->is_regular() || !at.material.has_scaled_target())
        return {};
      const Number       &eta   = at.material.importance();
      PointStress<Number> found = this->stress_towards(D);
      if (scene.blended_part > 0. && eta > Number(0.))
        found.by_wish = combine(Number(1.), found.by_wish,
                                Number(scene.blended_part) * (Number(1.) - eta) / eta,
                                stress(cell.own_material(), D));
      found = found.scaled(Number(share));
      for (const PatchFactors &factors : of_patches)
      {
        found += this->stress_of_traces(factors);
        found.by_shape
            = combine(Number(1.), found.by_shape,
                      Number(2.) * constant<Number>(factors[PatchSum::square]), at.shape);
        if constexpr (Cell::traits.has_volumetric_energy)
          found.by_shape
              = combine(Number(1.), found.by_shape,
                        constant<Number>(factors[PatchSum::volume_change]), cofactors(at.shape));
      }
      if constexpr (Cell::traits.has_volumetric_energy)
        found.by_shape = combine(Number(1.), found.by_shape, Number(share) * change_of_importance(),
                                 of_examples_alone());
      found.by_wish = times(eta, found.by_wish);
      return found;
    }

    PatchSums<Number>
    of_patch() const
    {
      PatchSums<Number> sums     = this->dilatation(trace(D));
      sums[PatchSum::square]     = contract(at.shape, at.shape);
      sums[PatchSum::importance] = at.material.importance();
      if (at.material.has_own_examples())
        sums[PatchSum::excess] = at.material.excess(D).lambda_of_patches;
      if constexpr (Cell::traits.has_guard_of_patches())
        if (this->may_be_thin()) // hardly ever
          sums[PatchSum::guard] = guard_of_patch();
      if constexpr (Cell::traits.has_volumetric_energy)
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

    /// eta less its value: laws hold eta as a constant, and this term of value 0 adds the
    /// derivatives by it.
    Number
    change_of_importance() const
    {
      return at.importance - Number(scene.examples.importance);
    }

    /// The derivative by S of the part of the energy that is proportional to eta.
    Matrix3<Number>
    of_examples_alone() const
    {
      return combine(Number(1.), stress(cell.own_material(), cell.strain()), Number(-1.),
                     cell.elastic_force());
    }

    Number
    of_share() const
    {
      Number sum(0.);
      if constexpr (Cell::traits.has_volumetric_energy)
      {
        const Number change = change_of_importance();
        const Number of_strain
            = Number(0.5) * contract(stress(cell.own_material(), cell.strain()), cell.strain());
        sum += change * (of_strain - cell.elastic_density());
        if (cell.is_stretched()) // Eq. (24), proportional to eta
          sum += of_cells() * change / at.importance * cell.stretch().energy();
      }
      return sum;
    }

    /// Energy of the guard of Eq. (24); 0 if patches take it.
    Number
    of_guard() const
    {
      if constexpr (Cell::traits.has_guard)
        if (cell.is_stretched())
          return of_cells() * cell.stretch().energy();
      return Number(0.);
    }

    /// The weights' quadratic form beyond the Gram matrix of the targets.
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
      const Number share = Cell::traits.has_volumetric_energy ? at.importance : Number(1.);
      const StretchGuard<Number> guard(at.material.isotropic_part().scaled(share),
                                       cell.stretch_factor(), cell.product_of_sums());
      return guard.acts() ? guard.energy() : Number(0.);
    }

    const Matrix3<Number> D;
  };

  /// The energy of stiffness damping, Eq. (22), with s = 1. The wish is the weighted sum of earlier
  /// strains.
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

    /// See ElasticPoint.
    std::optional<PointStress<Number>>
    regular_stress(const double share, const FactorsAtPoint &of_patches)
    {
      if constexpr (Cell::traits.has_volumetric_energy) // their force is not of damping alone
        return {};
      const bool was_thin
          = Cell::traits.has_guard_of_patches() && ThinTrace<Number>::of_strain(at.wish).acts();
      if (!this->is_regular() || was_thin)
        return {};
      PointStress<Number> found = this->stress_towards(at.wish).scaled(Number(share));
      for (const PatchFactors &factors : of_patches)
        found += this->stress_of_traces(factors);
      return found;
    }

    PatchSums<Number>
    of_patch() const
    {
      return this->dilatation(trace(at.wish)
                              + this->supplement(ThinTrace<Number>::of_strain(at.wish)));
    }
  };

  /// Energy density at a point, patch terms included.
  template <typename Number>
  struct PointPotential
  {
    Number potential;
    Number by_guard_bound; ///< derivative by p_0 of Eq. (16)
  };

  /// Evaluate ElasticPoint or DampingPoint for a law, times `share`.
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

  /// The derivatives of the potential at a point where the law gives the forces, and the patch
  /// terms due to changes of the patches' factors.
  template <typename Number>
  struct RegularPoint
  {
    PointStress<Number> stress;
    Number              of_patches;
  };

  /// RegularPoint of ElasticPoint or DampingPoint; nothing where regular_stress() is not known.
  template <template <typename, typename> class Evaluation, typename Number>
  std::optional<RegularPoint<Number>>
  regular_point(const CellLaw             law,
                const PointScene         &scene,
                const PointPlace<Number> &at,
                const double              share,
                const FactorsAtPoint     &of_patches)
  {
    std::optional<RegularPoint<Number>> found;
    with_potential<Number>(law,
                           [&](auto model)
                           {
                             using Cell = typename decltype(model)::type;
                             Evaluation<Cell, Number> point(law, scene, at);
                             const auto stress = point.regular_stress(share, of_patches);
                             if (!stress)
                               return;
                             found = RegularPoint<Number>{ *stress, Number(0.) };
                             if constexpr (Cell::traits.trace_gradient_is_R)
                               for (const PatchFactors &factors : of_patches)
                               {
                                 const PatchSums<Number> sums = point.of_patch();
                                 for (std::size_t k = 0; k < PatchFactors::size; ++k)
                                   found->of_patches
                                       += Number(factors.numbers[k].change) * sums.numbers[k];
                               }
                           });
    return found;
  }

  /// The point's integrands in the sums of its patch.
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
