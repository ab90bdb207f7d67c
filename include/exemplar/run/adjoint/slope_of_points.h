// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_of_points_h
#define exemplar_slope_of_points_h

#include <exemplar/run/adjoint/point_potential.h>
#include <exemplar/run/adjoint/point_shape.h>
#include <exemplar/run/adjoint/slope_terms.h>

// The derivatives of the slope of a potential that is a sum over points and patches: that of each is evaluated
// with numbers that carry its change along the direction, and the derivatives of both by all that it depends on.

namespace Exemplar
{
  /// Of which the potential of a point has derivatives: E, nu, eta, the six entries of the wish, and those of
  /// the shape, six of S or nine of F.
  namespace OfPoint
  {
    constexpr std::size_t E = 0, nu = 1, eta = 2, wish = 3, shape = 9;
    constexpr std::size_t n_constants = 3, n_with_S = 15, n_with_F = 18;

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
    seeded_symmetric(const Matrix3<double> &A, const Matrix3<double> &dA, const std::size_t first)
    {
      const SymmetricEntries<double>    value = pack(A), change = pack(dA);
      SymmetricEntries<HyperDual<n_by>> entries;
      for (std::size_t k = 0; k < n_symmetric; ++k)
        entries[k] = seeded<n_by>(value[k], change[k], first + k);
      return unpack(entries);
    }

    template <std::size_t n_by>
    Matrix3<HyperDual<n_by>>
    seeded_shape(const PointShape &at)
    {
      const Matrix3<double> &A = at.get_value(), &dA = at.get_change();
      if (at.is_turned())
        return seeded_symmetric<n_by>(A, dA, shape);
      Matrix3<HyperDual<n_by>> result;
      for (std::size_t k = 0; k < 9; ++k)
        result[k / 3][k % 3] = seeded<n_by>(A[k / 3][k % 3], dA[k / 3][k % 3], shape + k);
      return result;
    }

    /// The matrix of which the product with a symmetric one has these derivatives by its entries.
    template <std::size_t n_by>
    Matrix3<HyperDual<0>>
    by_symmetric(const HyperDual<n_by> &number, const std::size_t first)
    {
      SymmetricEntries<HyperDual<0>> entries;
      for (std::size_t k = 0; k < n_symmetric; ++k)
      {
        const double part = k < 3 ? 1. : 0.5;
        entries[k]        = { part * number.by[first + k], part * number.change_by[first + k] };
      }
      return unpack(entries);
    }

    /// R^T P of a potential.
    inline Matrix3<HyperDual<0>>
    by_shape(const HyperDual<n_with_S> &potential, const PointShape &at)
    {
      return with_turn(seeded_symmetric<0>(at.get_value(), at.get_change(), 0),
                       by_symmetric(potential, shape));
    }

    inline Matrix3<HyperDual<0>>
    by_shape(const HyperDual<n_with_F> &potential, const PointShape & /*at*/)
    {
      Matrix3<HyperDual<0>> A;
      for (std::size_t k = 0; k < 9; ++k)
        A[k / 3][k % 3] = { potential.by[shape + k], potential.change_by[shape + k] };
      return A;
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
        sum += fe_space.volume(point)
               * potential_of<0>(place_of(point), part.share(point), {}).potential.change;
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

    /// All that the potential of a point depends on.
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

    /// As numbers with so many derivatives: function(place).
    template <std::size_t n_by, typename Function>
    auto
    with_place(const Point &point, const Function &function) const
    {
      using Number             = HyperDual<n_by>;
      const Number eta         = OfPoint::seeded<n_by>(scene.examples.importance, 0., OfPoint::eta);
      const auto   constant_of = [](const double value, const std::size_t k)
      { return OfPoint::seeded<n_by>(value, 0., k); };
      const Material::BodyConstants &body = point.material.body;
      const PointPlace<Number>       at{
        OfPoint::seeded_shape<n_by>(point.shape),
        OfPoint::seeded_symmetric<n_by>(point.wish.value, point.wish.change, OfPoint::wish),
        MaterialFunctions<Number>(point.material, constant_of(body.youngs_modulus, OfPoint::E),
                                  constant_of(body.poissons_ratio, OfPoint::nu), eta),
        eta
      };
      return function(at);
    }

    template <std::size_t n_by>
    PointPotential<HyperDual<n_by>>
    potential_of(const Point &point, const double share, const FactorsAtPoint &of_patches) const
    {
      return with_place<n_by>(point,
                              [&](const auto &at) {
                                return point_potential<Part::template Evaluation>(
                                    point.law, scene, at, share, of_patches);
                              });
    }

    /// By the law's forces, or where more than these acts by derivatives of the potential.
    PointStress<Changing>
    stress_of(const Point &point, const double share, const FactorsAtPoint &of_patches) const
    {
      const auto found = with_place<0>(point,
                                       [&](const auto &at) {
                                         return point_stress<Part::template Evaluation>(
                                             point.law, scene, at, share, of_patches);
                                       });
      if (found)
        return *found;
      if (point.shape.is_turned())
        return derivatives_of<OfPoint::n_with_S>(point, share, of_patches);
      return derivatives_of<OfPoint::n_with_F>(point, share, of_patches);
    }

    template <std::size_t n_by>
    PointStress<Changing>
    derivatives_of(const Point &point, const double share, const FactorsAtPoint &of_patches) const
    {
      const HyperDual<n_by> potential = potential_of<n_by>(point, share, of_patches).potential;
      return { OfPoint::by_shape(potential, point.shape),
               OfPoint::by_symmetric(potential, OfPoint::wish) };
    }

    PatchFactors
    sums_of(const unsigned int patch) const
    {
      PatchFactors sums;
      for (const unsigned int point : patches.points(patch))
      {
        const Point  at_point = place_of(point);
        PatchFactors of_point = with_place<0>(
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

    /// Returns the derivative by the bound of the guard (16).
    double
    add_point(const unsigned int point, SlopeDerivatives &sums)
    {
      const auto                  of_patches = factors_at(point);
      const double                share      = part.share(point);
      const Point                 at         = place_of(point);
      const auto                  found = potential_of<OfPoint::n_constants>(at, share, of_patches);
      const PointStress<Changing> stress    = stress_of(at, share, of_patches);
      const auto                 &potential = found.potential;
      const double                V         = fe_space.volume(point);
      const unsigned int          cell      = fe_space.cell_of(point);
      const auto [by_F, by_dF]              = at.shape.derivatives(stress.by_shape);
      add_forces(fe_space, point, times(V, by_F), sums.by_positions);
      Matrix3<double> by_gradients
          = combine(V, transpose_times(at.F, by_F), V, transpose_times(at.dF, by_dF));
      part.add_wish(point, wish_of(times(Changing(V), stress.by_wish)), of_patches, sums,
                    by_gradients);
      sums.by_young[cell] += V * potential.change_by[OfPoint::E];
      sums.by_poisson[cell] += V * potential.change_by[OfPoint::nu];
      sums.by_importance += V * potential.change_by[OfPoint::eta];
      const double slope = potential.change + of_guard_bound(point, of_patches);
      add_at_vertices(fe_space, cell,
                      combine(V * slope, identity_matrix<double>(), -1., by_gradients),
                      sums.by_rest_positions);
      return V * found.by_guard_bound.change;
    }

    static Wish
    wish_of(const Matrix3<Changing> &numbers)
    {
      Wish result;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
          result.change[i][j] = numbers[i][j].value;
          result.value[i][j]  = numbers[i][j].change;
        }
      return result;
    }

    /// The change of what the bound of the patch's guard adds, which depends on the volume alone.
    double
    of_guard_bound(const unsigned int point, const FactorsAtPoint &of_patches) const
    {
      double sum = 0.;
      for (const PatchFactors &factor : of_patches)
        sum += factor[PatchSum::bound].change
               * part.square_of_bound(patches.of_point(point), point);
      return sum;
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
