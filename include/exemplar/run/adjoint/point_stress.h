// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_stress_h
#define exemplar_point_stress_h

#include <exemplar/run/adjoint/laws_with_derivatives.h>
#include <exemplar/run/adjoint/patch_factors.h>
#include <exemplar/run/adjoint/point_elasticity.h>

#include <optional>

// The derivatives of the potential at a point by its shape and its wish, by the stress of its law
// for numbers that carry derivatives.

namespace Exemplar
{
  /// Settings that all points share.
  struct PointScene
  {
    BodyMaterial     of_body;
    ExampleConstants examples;
    double           blended_part; ///< share of the blended energy
  };

  /// The variables at a point.
  template <typename Number>
  struct PointPlace
  {
    PointPlace(const PointScene      &scene,
               const CellLaw          law,
               const unsigned int     cell,
               const Matrix3<Number> &shape,
               const Matrix3<Number> &wish,
               const double           share)
        : scene(scene), law(law), shape(shape), wish(wish),
          share(share), examples{ OfPoint::seeded<Number>(scene.examples.guard_bound,
                                                          OfPoint::guard_bound),
                                  OfPoint::seeded<Number>(scene.examples.importance,
                                                          OfPoint::eta) },
          elasticity(scene.of_body, cell, examples.importance)
    {
    }

    const PointScene       &scene;
    CellLaw                 law;
    Matrix3<Number>         shape; ///< S or F, as the law needs it: see PointShape
    Matrix3<Number>         wish;  ///< the blend of the examples' strains, before Eq. (31)
    double                  share; ///< factor of the point's own energy
    ExampleNumbers<Number>  examples;
    PointElasticity<Number> elasticity;
  };

  /// The derivatives of a patch's potential by its sums, with their changes along the direction.
  using PatchFactors = PatchSums<OfPoint::Changing>;

  /// The derivatives of a potential by the shape, as R^T P, and by the wish or the target; and the
  /// sum of the integrands of the point's patch times the changes of their factors.
  template <typename Number>
  struct PointStress
  {
    Matrix3<Number> by_shape, by_wish;
    Number          of_patch = Number(0.);
  };

  /// A cell with its law, and its integrands in the sums of its patch.
  template <typename Cell, typename Number>
  class PointOfLaw
  {
  public:
    explicit PointOfLaw(const PointPlace<Number> &at)
        : at(at), cell(at.elasticity.template of_law<typename Cell::Constants>(at.law),
                       identity_matrix<Number>(),
                       at.shape,
                       at.examples)
    {
      if constexpr (Cell::traits.has_guard_of_patches())
        if (at.scene.of_body.has_patches
            && StretchGuard<Number>::may_act(cell.stretch_factor(), cell.product_of_sums()))
          thin.emplace(cell.stretch_factor(), cell.product_of_sums());
    }

  protected:
    /// The derivatives of the share of the law's energy by the shape and the target D.
    PointStress<Number>
    stress_towards(const Matrix3<Number> &D)
    {
      cell.set_target(D);
      return { times(at.share, cell.force()), times(-at.share, cell.weight_stress(D)) };
    }

    /// The sums of the dilatation, where `wish` is the trace of the target.
    PatchSums<Number>
    dilatation(const Number &wish) const
    {
      return dilatation_sums(at.elasticity.lambda_of_patches(), extended_trace(), wish);
    }

    /// The trace of the strain, continued smoothly in thin cells.
    Number
    extended_trace() const
    {
      return thin ? trace(cell.strain()) + thin->supplement() : trace(cell.strain());
    }

    /// The derivatives of the potential of a patch with these factors through the traces.
    PointStress<Number>
    stress_of_traces(const PatchFactors &factors) const
    {
      const Matrix3<Number> I = identity_matrix<Number>();
      const Number          pressure
          = factor(factors, PatchSum::trace)
            + Number(2.) * extended_trace() * factor(factors, PatchSum::trace_square);
      const Matrix3<Number> by_trace
          = thin ? combine(Number(1.), I, Number(1.), thin->gradient()) : I;
      return { times(pressure, by_trace), times(factor(factors, PatchSum::wish), I) };
    }

    static Number
    sum_of_changes(const PatchFactors &factors, const PatchSums<Number> &sums)
    {
      Number sum(0.);
      for (std::size_t k = 0; k < sums.size; ++k)
        sum += Number(factors.numbers[k].by[0]) * sums.numbers[k];
      return sum;
    }

    static Number
    factor(const PatchFactors &factors, const PatchSum sum)
    {
      return Number(factors[sum].value, factors[sum].by[0]);
    }

    static void
    add(const Number &factor, const Matrix3<Number> &A, Matrix3<Number> &to)
    {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          to[i][j] += factor * A[i][j];
    }

    const PointPlace<Number>        &at;
    Cell                             cell;
    std::optional<ThinTrace<Number>> thin; ///< where the cell may be thin
  };

  /// The elastic energy, with examples.
  template <typename Cell, typename Number>
  class ElasticPoint : public PointOfLaw<Cell, Number>
  {
    using Base = PointOfLaw<Cell, Number>;
    using Base::add;
    using Base::at;
    using Base::cell;
    using Base::factor;
    using Base::thin;

  public:
    explicit ElasticPoint(const PointPlace<Number> &at) : Base(at), D(at.elasticity.target(at.wish))
    {
    }

    /// The derivatives of the energy, with the terms of its patch, if it has one.
    PointStress<Number>
    stress(const PatchFactors *factors)
    {
      PointStress<Number> found = this->stress_towards(D);
      if (!at.scene.of_body.has_patches && cell.is_stretched())
        add(Number(1.), cell.stretch().force(), found.by_shape);
      if (at.scene.blended_part > 0.)
        add(Number(at.scene.blended_part), at.elasticity.excess_stress(cell.own_material(), D),
            found.by_wish);
      if (factors != nullptr)
        add_patch(*factors, found);
      found.by_wish = at.elasticity.by_wish(found.by_wish);
      return found;
    }

    PatchSums<Number>
    of_patch() const
    {
      PatchSums<Number> sums     = this->dilatation(trace(D));
      sums[PatchSum::square]     = contract(at.shape, at.shape);
      sums[PatchSum::importance] = at.elasticity.importance();
      sums[PatchSum::excess]     = at.elasticity.excess_of_patches();
      if constexpr (Cell::traits.has_guard_of_patches())
        if (thin)
          sums[PatchSum::guard] = guard().energy_or_zero();
      if constexpr (Cell::traits.has_volumetric_energy)
        sums[PatchSum::volume_change] = volume_change(cell.strain());
      sums[PatchSum::trace_square] = sums[PatchSum::trace] * sums[PatchSum::trace];
      return sums;
    }

  private:
    void
    add_patch(const PatchFactors &factors, PointStress<Number> &found) const
    {
      const PointStress<Number> of_traces = this->stress_of_traces(factors);
      add(Number(1.), of_traces.by_shape, found.by_shape);
      add(Number(1.), of_traces.by_wish, found.by_wish);
      add(Number(2.) * factor(factors, PatchSum::square), at.shape, found.by_shape);
      if constexpr (Cell::traits.has_volumetric_energy)
        add(factor(factors, PatchSum::volume_change), cofactors(at.shape), found.by_shape);
      if constexpr (Cell::traits.has_guard_of_patches())
        if (thin && guard().acts())
          add(factor(factors, PatchSum::guard), guard().force(), found.by_shape);
      found.of_patch = this->sum_of_changes(factors, of_patch());
    }

    /// The guard of the patch in this cell.
    StretchGuard<Number>
    guard() const
    {
      const Number share = Cell::traits.has_volumetric_energy ? at.examples.importance : Number(1.);
      return StretchGuard<Number>(at.elasticity.isotropic_part().scaled(share),
                                  cell.stretch_factor(), cell.product_of_sums());
    }

    const Matrix3<Number> D;
  };

  /// The law whose energy is that of damping: a background's own energy has none.
  template <typename Cell, typename Number>
  using DampedCell
      = std::conditional_t<Cell::traits.has_volumetric_energy, CorotationalCell<Number>, Cell>;

  /// The energy of stiffness damping, Eq. (22), with s = 1. The wish is the weighted sum of earlier
  /// strains.
  template <typename Cell, typename Number>
  class DampingPoint : public PointOfLaw<DampedCell<Cell, Number>, Number>
  {
    using Base = PointOfLaw<DampedCell<Cell, Number>, Number>;
    using Base::add;
    using Base::at;

  public:
    explicit DampingPoint(const PointPlace<Number> &at) : Base(at)
    {
      if constexpr (Cell::traits.has_guard_of_patches())
        if (at.scene.of_body.has_patches)
          past.emplace(ThinTrace<Number>::of_strain(at.wish));
    }

    /// See ElasticPoint.
    PointStress<Number>
    stress(const PatchFactors *factors)
    {
      PointStress<Number> found = this->stress_towards(at.wish);
      if (factors == nullptr)
        return found;
      const PointStress<Number> of_traces = this->stress_of_traces(*factors);
      add(Number(1.), of_traces.by_shape, found.by_shape);
      add(Number(1.), of_traces.by_wish, found.by_wish);
      if (was_thin())
        add(this->factor(*factors, PatchSum::wish), past->gradient(), found.by_wish);
      found.of_patch = this->sum_of_changes(*factors, of_patch());
      return found;
    }

    PatchSums<Number>
    of_patch() const
    {
      return this->dilatation(was_thin() ? trace(at.wish) + past->supplement() : trace(at.wish));
    }

  private:
    bool
    was_thin() const
    {
      return past && past->acts();
    }

    std::optional<ThinTrace<Number>> past; ///< of the earlier strain
  };
} // namespace Exemplar

#endif
