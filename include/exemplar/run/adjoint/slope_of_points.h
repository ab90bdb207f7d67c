// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_of_points_h
#define exemplar_slope_of_points_h

#include <exemplar/run/adjoint/point_potential.h>
#include <exemplar/run/adjoint/slope_terms.h>

// The derivatives of the slope of a potential that is a sum over points and patches: that of each is evaluated
// with numbers that carry its change along the direction, and the derivatives of both by all that it depends on.

namespace Exemplar
{
  /// Of which the potential of a point has derivatives: F, the six entries of the wish, E, nu, eta.
  namespace OfPoint
  {
    constexpr std::size_t F = 0, wish = 9, E = 15, nu = 16, eta = 17, n = 18;

    /// The number with derivative number k.
    template <std::size_t n_by>
    HyperDual<n_by>
    seeded(const double value, const double change, const std::size_t k)
    {
      HyperDual<n_by> number(value, change);
      if (k < n_by)
        number.by[k] = 1.;
      return number;
    }

    template <std::size_t n_by>
    Matrix3<HyperDual<n_by>>
    seeded(const Matrix3<double> &A, const Matrix3<double> &dA)
    {
      Matrix3<HyperDual<n_by>> result;
      for (std::size_t k = 0; k < 9; ++k)
        result[k / 3][k % 3] = seeded<n_by>(A[k / 3][k % 3], dA[k / 3][k % 3], F + k);
      return result;
    }

    template <std::size_t n_by>
    Matrix3<HyperDual<n_by>>
    seeded_symmetric(const Matrix3<double> &A, const Matrix3<double> &dA)
    {
      const SymmetricEntries<double>    value = pack(A), change = pack(dA);
      SymmetricEntries<HyperDual<n_by>> entries;
      for (std::size_t k = 0; k < n_symmetric; ++k)
        entries[k] = seeded<n_by>(value[k], change[k], wish + k);
      return unpack(entries);
    }

    inline Matrix3<double>
    by_F(const std::array<double, n> &by)
    {
      Matrix3<double> A;
      for (std::size_t k = 0; k < 9; ++k)
        A[k / 3][k % 3] = by[F + k];
      return A;
    }

    /// The matrix of which the product with a symmetric one has these derivatives by its entries.
    inline Matrix3<double>
    by_wish(const std::array<double, n> &by)
    {
      SymmetricEntries<double> entries;
      for (std::size_t k = 0; k < n_symmetric; ++k)
        entries[k] = (k < 3 ? 1. : 0.5) * by[wish + k];
      return unpack(entries);
    }
  } // namespace OfPoint

  /// What a point's strain is drawn to, and how that changes along the direction.
  struct Wish
  {
    Matrix3<double> value, change;
  };

  /// `Part` says which potential: Part::Evaluation of point_potential.h, factors share(point) and
  /// share_of_patch(patch) of it, wish(point), patch_scene(law), and square_of_bound(patch, point) for the
  /// guard (26). By add_wish() and add_guard_bound() it hears of the derivatives by what is its own.
  template <typename Part>
  class SlopeOfPoints
  {
  public:
    /// All must outlive it.
    SlopeOfPoints(const Problem &problem, const Vector &along, Part &part)
        : problem(problem), along(along), fe_space(problem.body.fe_space),
          patches(problem.body.patches),
          laws(part.get_laws()), scene{ problem.examples.poses.constants(),
                                        blended_part(problem.parameters.examples.energy),
                                        std::min<double>(1., patches.size()) },
          part(part)
    {
      for (unsigned int patch = 0; patch < patches.size(); ++patch)
        of_patches.push_back(potential_of_patch(patch));
      for (const OfPatch &potential : of_patches)
      {
        PatchFactors of_patch;
        for (std::size_t k = 0; k < PatchFactors::size; ++k)
          of_patch.numbers[k] = Changing(potential.by[k], potential.change_by[k]);
        factors.push_back(of_patch);
      }
    }

    /// The slope itself.
    double
    slope() const
    {
      double sum = 0.;
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
        sum += fe_space.volume(point) * potential_of<0>(point, {}).potential.change;
      for (const OfPatch &potential : of_patches)
        sum += potential.change;
      return sum;
    }

    /// Add its derivatives.
    void
    add_to(SlopeDerivatives &sums)
    {
      for (const OfPatch &potential : of_patches)
        sums.by_importance += potential.change_by[PatchFactors::size];
      double by_guard_bound = 0.;
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
        by_guard_bound += add_point(point, sums);
      if (by_guard_bound != 0.)
        part.add_guard_bound(by_guard_bound, sums);
    }

  private:
    using Changing = HyperDual<0>;
    using OfPatch  = HyperDual<PatchFactors::size + 1>; // and by eta

    FactorsAtPoint
    factors_at(const unsigned int point) const
    {
      if (factors.empty())
        return {};
      return { &factors[patches.of_point(point)], 1 };
    }

    /// With derivatives where numbers carry them: function(law, place).
    template <std::size_t n_by, typename Function>
    auto
    with_place(const unsigned int point, const Function &function) const
    {
      using Number             = HyperDual<n_by>;
      const unsigned int  cell = fe_space.cell_of(point);
      const auto          F    = fe_space.deformation_gradient(point, problem.state.positions);
      const auto          dF   = fe_space.deformation_gradient(point, along);
      const Wish          wish = part.wish(point);
      const PointMaterial material(problem.body.material, problem.body.cell_material,
                                   problem.parameters.examples.acts_on, scene.part_of_patches,
                                   cell);
      const Number        eta = OfPoint::seeded<n_by>(scene.examples.importance, 0., OfPoint::eta);
      const auto          constant_of = [](const double value, const std::size_t k)
      { return OfPoint::seeded<n_by>(value, 0., k); };
      const PointPlace<Number> at{
        closest_rotation(F), OfPoint::seeded<n_by>(F, dF),
        OfPoint::seeded_symmetric<n_by>(wish.value, wish.change),
        MaterialFunctions<Number>(material, constant_of(material.body.youngs_modulus, OfPoint::E),
                                  constant_of(material.body.poissons_ratio, OfPoint::nu), eta),
        eta
      };
      return function(laws[cell], at);
    }

    template <std::size_t n_by>
    PointPotential<HyperDual<n_by>>
    potential_of(const unsigned int point, const FactorsAtPoint &of_patches) const
    {
      return with_place<n_by>(point,
                              [&](const CellLaw law, const auto &at)
                              {
                                return point_potential<Part::template Evaluation>(
                                    law, scene, at, part.share(point), of_patches);
                              });
    }

    PatchFactors
    sums_of(const unsigned int patch) const
    {
      PatchFactors sums;
      for (const unsigned int point : patches.points(patch))
      {
        PatchFactors of_point
            = with_place<0>(point, [&](const CellLaw law, const auto &at)
                            { return patch_sums<Part::template Evaluation>(law, scene, at); });
        of_point[PatchSum::bound] = Changing(part.square_of_bound(patch, point));
        const Changing volume(fe_space.volume(point));
        for (std::size_t k = 0; k < PatchFactors::size; ++k)
          sums.numbers[k] += volume * of_point.numbers[k];
      }
      return sums;
    }

    OfPatch
    potential_of_patch(const unsigned int patch) const
    {
      const PatchFactors sums = sums_of(patch);
      PatchSums<OfPatch> seeded_sums;
      for (std::size_t k = 0; k < PatchFactors::size; ++k)
      {
        seeded_sums.numbers[k]       = constant<OfPatch>(sums.numbers[k]);
        seeded_sums.numbers[k].by[k] = 1.;
      }
      const auto law = traits_of(laws[fe_space.cell_of(patches.points(patch).front())]);
      OfPatch    eta(scene.examples.importance);
      eta.by[PatchFactors::size] = 1.;
      return OfPatch(part.share_of_patch(patch))
             * patch_potential(part.patch_scene(scene, law), seeded_sums, eta);
    }

    /// Returns the derivative by the bound of the guard (16).
    double
    add_point(const unsigned int point, SlopeDerivatives &sums)
    {
      const auto            of_patches = factors_at(point);
      const auto            found      = potential_of_whole(point, of_patches);
      const auto           &potential  = found.potential;
      const double          V          = fe_space.volume(point);
      const unsigned int    cell       = fe_space.cell_of(point);
      const Matrix3<double> F     = fe_space.deformation_gradient(point, problem.state.positions);
      const Matrix3<double> dF    = fe_space.deformation_gradient(point, along);
      const Matrix3<double> by_F  = OfPoint::by_F(potential.change_by),
                            by_dF = OfPoint::by_F(potential.by);
      add_forces(fe_space, point, times(V, by_F), sums.by_positions);
      Matrix3<double> by_gradients
          = combine(V, transpose_times(F, by_F), V, transpose_times(dF, by_dF));
      part.add_wish(point,
                    { times(V, OfPoint::by_wish(potential.change_by)),
                      times(V, OfPoint::by_wish(potential.by)) },
                    of_patches, sums, by_gradients);
      sums.by_young[cell] += V * potential.change_by[OfPoint::E];
      sums.by_poisson[cell] += V * potential.change_by[OfPoint::nu];
      sums.by_importance += V * potential.change_by[OfPoint::eta];
      add_at_vertices(fe_space, cell,
                      combine(V * potential.change, identity_matrix<double>(), -1., by_gradients),
                      sums.by_rest_positions);
      return V * found.by_guard_bound.change;
    }

    /// With its share, and with the bound of the patch's guard, which depends on the volume alone.
    PointPotential<HyperDual<OfPoint::n>>
    potential_of_whole(const unsigned int point, const FactorsAtPoint &of_patches) const
    {
      using Number = HyperDual<OfPoint::n>;
      auto found   = potential_of<OfPoint::n>(point, of_patches);
      for (const PatchFactors &factor : of_patches)
        found.potential += constant<Number>(factor[PatchSum::bound])
                           * Number(part.square_of_bound(patches.of_point(point), point));
      return found;
    }

    const Problem            &problem;
    const Vector             &along;
    const FESpace            &fe_space;
    const Patches            &patches;
    const LawsOfCells        &laws;
    const PointScene          scene;
    Part                     &part;
    std::vector<OfPatch>      of_patches; ///< the potential of each
    std::vector<PatchFactors> factors;    ///< its derivatives
  };
} // namespace Exemplar

#endif
