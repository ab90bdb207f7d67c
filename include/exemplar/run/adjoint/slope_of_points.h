// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_of_points_h
#define exemplar_slope_of_points_h

#include <exemplar/base/loop_parts.h>
#include <exemplar/run/adjoint/point_slope.h>
#include <exemplar/run/adjoint/slope_terms.h>

// The derivatives of the slope of a potential that is a sum over points and patches. Each term is
// evaluated with numbers that carry its change along the direction and the derivatives of value and
// change.

namespace Exemplar
{
  /// `Part` specifies the potential: Part::Evaluation of point_potential.h, its factors
  /// share(point) and share_of_patch(patch), wish(point), patch_scene(law), and
  /// square_of_bound(patch, point) for the guard (26). add_wish() and add_guard_bound() pass on
  /// derivatives by the wish and by p_0.
  template <typename Part>
  class SlopeOfPoints
  {
  public:
    /// All arguments must outlive it.
    SlopeOfPoints(const Problem &problem, const Vector &along, Part &part)
        : problem(problem), along(along), fe_space(problem.body.fe_space),
          patches(problem.body.patches),
          laws(part.get_laws()), scene{ problem.examples.poses.constants(),
                                        blended_part(problem.parameters.examples.energy),
                                        std::min<double>(1., patches.size()) },
          part(part)
    {
      of_patches.resize(patches.size());
      for_each_part(n_parts, patches.size(), problem.parameters.solver.n_threads,
                    [this](const std::size_t, const std::size_t begin, const std::size_t end)
                    {
                      for (std::size_t patch = begin; patch < end; ++patch)
                        of_patches[patch] = potential_of_patch(patch);
                    });
      for (const OfPatch &potential : of_patches)
      {
        PatchFactors of_patch;
        for (std::size_t k = 0; k < PatchFactors::size; ++k)
          of_patch.numbers[k] = Changing(potential.by[k], potential.change_by[k]);
        factors.push_back(of_patch);
      }
    }

    /// The slope itself, by direct evaluation.
    double
    slope() const
    {
      double sum = 0.;
      for_each_found<double>([this](const unsigned int point) { return slope_of_energy(point); },
                             [&](const unsigned int, const double of_point) { sum += of_point; });
      for (const OfPatch &potential : of_patches)
        sum += potential.change;
      return sum;
    }

    /// Add the slope's derivatives to `sums`.
    void
    add_to(SlopeDerivatives &sums)
    {
      for (const OfPatch &potential : of_patches)
        sums.by_importance += potential.change_by[PatchFactors::size];
      double by_guard_bound = 0.;
      for_each_found<Contribution>([this](const unsigned int point) { return contribution(point); },
                                   [&](const unsigned int point, const Contribution &of_point)
                                   {
                                     add(point, of_point, sums);
                                     by_guard_bound += of_point.by_guard_bound;
                                   });
      if (by_guard_bound != 0.)
        part.add_guard_bound(by_guard_bound, sums);
    }

  private:
    using Changing = HyperDual<0>;

    static constexpr std::size_t n_parts = 16; ///< of loops, whatever the threads

    using OfPatch = HyperDual<PatchFactors::size + 1>; // and by eta

    /// Evaluate find(point) at all points in parallel, some at a time, and take the results in the
    /// points' order.
    template <typename Found, typename Find, typename Take>
    void
    for_each_found(const Find &find, const Take &take) const
    {
      constexpr unsigned int n_at_once = 1024;
      const unsigned int     n         = fe_space.n_points();
      std::vector<Found>     found(std::min(n, n_at_once));
      for (unsigned int first = 0; first < n; first += n_at_once)
      {
        const unsigned int n_found = std::min(n_at_once, n - first);
        for_each_part(n_parts, n_found, problem.parameters.solver.n_threads,
                      [&](const std::size_t, const std::size_t begin, const std::size_t end)
                      {
                        for (std::size_t i = begin; i < end; ++i)
                          found[i] = find(first + i);
                      });
        for (unsigned int i = 0; i < n_found; ++i)
          take(first + i, found[i]);
      }
    }

    /// Slope of a point's energy without its patch.
    double
    slope_of_energy(const unsigned int point) const
    {
      const Point at = place_of(point);
      return fe_space.volume(point)
             * with_place<Changing>(at,
                                    [&](const auto &place) {
                                      return point_potential<Part::template Evaluation>(
                                          at.law, scene, place, part.share(point), {});
                                    })
                   .potential.change;
    }

    FactorsAtPoint
    factors_at(const unsigned int point) const
    {
      if (factors.empty())
        return {};
      return { &factors[patches.of_point(point)], 1 };
    }

    /// The variables of a point's potential.
    struct Point
    {
      CellLaw         law;
      Matrix3<double> F, dF;
      PointShape      shape;
      Wish            wish;
      PointMaterial   material;
    };

    Point
    place_of(const unsigned int point) const
    {
      const unsigned int    cell = fe_space.cell_of(point);
      const Matrix3<double> F    = fe_space.deformation_gradient(point, problem.state.positions);
      const Matrix3<double> dF   = fe_space.deformation_gradient(point, along);
      return { laws[cell],
               F,
               dF,
               PointShape(traits_of(laws[cell]).has_rotations, F, dF),
               part.wish(point),
               PointMaterial(problem.body.material, problem.body.cell_material,
                             problem.parameters.examples.acts_on, scene.part_of_patches, cell) };
    }

    /// function(place) with the variables as numbers with derivatives.
    template <typename Number, typename Function>
    auto
    with_place(const Point &point, const Function &function) const
    {
      const Number eta = OfPoint::seeded<Number>(scene.examples.importance, 0., OfPoint::eta);
      const auto   constant_of = [](const double value, const std::size_t k)
      { return OfPoint::seeded<Number>(value, 0., k); };
      const Material::BodyConstants &body = point.material.body;
      const PointPlace<Number>       at{
        OfPoint::seeded_shape<Number>(point.shape),
        OfPoint::seeded_symmetric<Number>(point.wish.value, point.wish.change, OfPoint::wish),
        MaterialFunctions<Number>(point.material, constant_of(body.youngs_modulus, OfPoint::E),
                                  constant_of(body.poissons_ratio, OfPoint::nu), eta),
        eta
      };
      return function(at);
    }

    PointSlope
    slope_of(const Point &point, const double share, const FactorsAtPoint &of_patches) const
    {
      const auto found
          = with_place<OfPoint::Regular>(point,
                                         [&](const auto &at) {
                                           return regular_point<Part::template Evaluation>(
                                               point.law, scene, at, share, of_patches);
                                         });
      if (found)
        return slope_of_stress(point.shape, point.wish, *found);
      if (point.shape.is_turned())
        return slope_of_potential<OfPoint::n_with_S>(point, share, of_patches);
      return slope_of_potential<OfPoint::n_with_F>(point, share, of_patches);
    }

    /// Slope where the law does not give the forces, by derivatives of the potential.
    template <std::size_t n_by>
    PointSlope
    slope_of_potential(const Point          &point,
                       const double          share,
                       const FactorsAtPoint &of_patches) const
    {
      using Number            = HyperDual<n_by>;
      const auto    found     = with_place<Number>(point,
                                            [&](const auto &at) {
                                              return point_potential<Part::template Evaluation>(
                                                  point.law, scene, at, share, of_patches);
                                            });
      const Number &potential = found.potential;
      return { potential.change,
               { OfPoint::by_shape(potential, point.shape),
                 OfPoint::by_symmetric(potential, OfPoint::wish) },
               { { potential.change_by[OfPoint::E], potential.change_by[OfPoint::nu],
                   potential.change_by[OfPoint::eta] } },
               found.by_guard_bound.change };
    }

    PatchFactors
    sums_of(const unsigned int patch) const
    {
      PatchFactors sums;
      for (const unsigned int point : patches.points(patch))
      {
        const Point  at_point = place_of(point);
        PatchFactors of_point = with_place<Changing>(
            at_point, [&](const auto &at)
            { return patch_sums<Part::template Evaluation>(at_point.law, scene, at); });
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

    /// A point's part of the slope and its derivatives, to be added at its nodes and its cell.
    struct Contribution
    {
      Matrix3<double>    by_F, by_gradients;
      Wish               by_wish;
      OfPoint::Constants by_constants;
      double             slope, by_guard_bound;
    };

    Contribution
    contribution(const unsigned int point) const
    {
      const auto       of_patches = factors_at(point);
      const Point      at         = place_of(point);
      const double     V          = fe_space.volume(point);
      const PointSlope found      = slope_of(at, part.share(point), of_patches);
      const auto [by_F, by_dF]    = at.shape.derivatives(found.stress.by_shape);
      Contribution result{ times(V, by_F),
                           combine(V, transpose_times(at.F, by_F), V,
                                   transpose_times(at.dF, by_dF)),
                           slope_by_wish(times(Changing(V), found.stress.by_wish)),
                           found.by_constants,
                           V * (found.slope + of_guard_bound(point, of_patches)),
                           V * found.by_guard_bound };
      for (double &number : result.by_constants)
        number *= V;
      return result;
    }

    /// The point's part of the change of the bound of its patch's guard, through its volume.
    double
    of_guard_bound(const unsigned int point, const FactorsAtPoint &of_patches) const
    {
      double sum = 0.;
      for (const PatchFactors &factor : of_patches)
        sum += factor[PatchSum::bound].change
               * part.square_of_bound(patches.of_point(point), point);
      return sum;
    }

    void
    add(const unsigned int point, const Contribution &of_point, SlopeDerivatives &sums)
    {
      const unsigned int cell = fe_space.cell_of(point);
      add_forces(fe_space, point, of_point.by_F, sums.by_positions);
      Matrix3<double> by_gradients = of_point.by_gradients;
      part.add_wish(point, of_point.by_wish, factors_at(point), sums, by_gradients);
      sums.by_young[cell] += of_point.by_constants[OfPoint::E];
      sums.by_poisson[cell] += of_point.by_constants[OfPoint::nu];
      sums.by_importance += of_point.by_constants[OfPoint::eta];
      add_at_vertices(fe_space, cell,
                      combine(of_point.slope, identity_matrix<double>(), -1., by_gradients),
                      sums.by_rest_positions);
    }

    const Problem            &problem;
    const Vector             &along;
    const FESpace            &fe_space;
    const Patches            &patches;
    const LawsOfCells        &laws;
    const PointScene          scene;
    Part                     &part;
    std::vector<OfPatch>      of_patches; ///< potential of each patch
    std::vector<PatchFactors> factors;    ///< derivatives of the potentials by the sums
  };
} // namespace Exemplar

#endif
