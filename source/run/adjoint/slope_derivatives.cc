// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/point_potential.h>
#include <exemplar/run/adjoint/slope_terms.h>

// The derivatives of the slope of Psi, Eqs. (5), (25), (26), (37) and (38): the potential of each point and of
// each patch is evaluated with numbers that carry its change along the direction, and the derivatives of both
// by all that it depends on.

namespace Exemplar
{
  namespace
  {
    using Matrix = Matrix3<double>;

    /// Of which the potential of a point has derivatives: F, the six entries of the wish, E, nu, eta.
    constexpr std::size_t of_F = 0, of_wish = 9, of_E = 15, of_nu = 16, of_eta = 17,
                          n_of_point = 18;

    using OfPoint   = HyperDual<n_of_point>;
    using Changing  = HyperDual<0>;
    using OfPatch   = HyperDual<PatchSums<double>::size + 1>; // and by eta
    using PatchTerm = PatchSums<Changing>;

    /// With derivatives number `first` and following.
    template <typename Number>
    Matrix3<Number>
    seeded(const Matrix &A, const Matrix &dA, const std::size_t first)
    {
      Matrix3<Number> result;
      for (std::size_t k = 0; k < 9; ++k)
      {
        Number &entry = result[k / 3][k % 3];
        entry         = Number(A[k / 3][k % 3], dA[k / 3][k % 3]);
        if (first + k < entry.by.size())
          entry.by[first + k] = 1.;
      }
      return result;
    }

    template <typename Number>
    Matrix3<Number>
    seeded_symmetric(const Matrix &A, const Matrix &dA, const std::size_t first)
    {
      const SymmetricEntries<double> value = pack(A), change = pack(dA);
      SymmetricEntries<Number>       entries;
      for (std::size_t k = 0; k < n_symmetric; ++k)
      {
        entries[k] = Number(value[k], change[k]);
        if (first + k < entries[k].by.size())
          entries[k].by[first + k] = 1.;
      }
      return unpack(entries);
    }

    template <typename Number>
    Number
    seeded(const double value, const std::size_t k)
    {
      Number number(value);
      if (k < number.by.size())
        number.by[k] = 1.;
      return number;
    }

    template <std::size_t n>
    Matrix
    matrix_of(const std::array<double, n> &by)
    {
      Matrix A;
      for (std::size_t k = 0; k < 9; ++k)
        A[k / 3][k % 3] = by[of_F + k];
      return A;
    }

    /// The matrix of which the product with a symmetric one has these derivatives by its entries.
    template <std::size_t n>
    Matrix
    symmetric_matrix_of(const std::array<double, n> &by)
    {
      SymmetricEntries<double> entries;
      for (std::size_t k = 0; k < n_symmetric; ++k)
        entries[k] = (k < 3 ? 1. : 0.5) * by[of_wish + k];
      return unpack(entries);
    }

    template <typename Number>
    Number
    constant(const Changing &number)
    {
      return Number(number.value, number.change);
    }

    class Slope
    {
    public:
      Slope(const Problem &problem, const Direction &direction)
          : problem(problem), direction(direction), fe_space(problem.body.fe_space),
            patches(problem.body.patches), poses(problem.examples.poses),
            laws(laws_of_cells(problem.parameters, problem.body)),
            scene{ poses.constants(), blended_part(problem.parameters.examples.energy),
                   patches.size() > 0 },
            strains(problem, laws)
      {
        initialize();
        find_patches();
        for (unsigned int point = 0; point < fe_space.n_points(); ++point)
          add_point(point);
        if (by_guard_bound != 0.)
          add_guard_bound();
      }

      SlopeDerivatives
      take()
      {
        return std::move(sums);
      }

    private:
      void
      initialize()
      {
        const unsigned int n = fe_space.n_dofs(), m = fe_space.n_cells();
        for (Vector *field : { &sums.by_positions, &sums.by_rest_positions, &sums.by_nodal_forces })
          field->reinit(n);
        sums.by_weights.assign(poses.n_weights(), 0.);
        sums.by_poses.assign(poses.size(), Vector(n));
        for (auto *cells : { &sums.by_young, &sums.by_poisson, &sums.by_density })
          cells->assign(m, 0.);
      }

      /// The potential of a point, with derivatives where numbers carry them.
      template <typename Number>
      PointPotential<Number>
      potential_of(const unsigned int point) const
      {
        const unsigned int       cell = fe_space.cell_of(point);
        const Matrix             F  = fe_space.deformation_gradient(point, problem.state.positions);
        const Matrix             dF = fe_space.deformation_gradient(point, direction.positions);
        const PointMaterial      material(problem.body.material, problem.body.cell_material,
                                          problem.parameters.examples.acts_on, cell);
        const Number             eta = seeded<Number>(scene.examples.importance, of_eta);
        const PointPlace<Number> at{
          closest_rotation(F), seeded<Number>(F, dF, of_F),
          seeded_symmetric<Number>(strains.wish(point, problem.state.weights),
                                   strains.wish(point, direction.weights), of_wish),
          MaterialFunctions<Number>(material, seeded<Number>(material.body.youngs_modulus, of_E),
                                    seeded<Number>(material.body.poissons_ratio, of_nu), eta),
          eta
        };
        return point_potential<Number>(laws[cell], scene, at);
      }

      void
      find_patches()
      {
        for (unsigned int patch = 0; patch < patches.size(); ++patch)
        {
          bound_poses.push_back(strains.pose_of_bound(patch));
          PatchTerm of_patch;
          for (const unsigned int point : patches.points(patch))
          {
            PatchTerm term        = potential_of<Changing>(point).of_patch;
            term[PatchSum::bound] = Changing(square_of_bound(patch, point));
            const Changing volume(fe_space.volume(point));
            for (std::size_t k = 0; k < PatchTerm::size; ++k)
              of_patch.numbers[k] += volume * term.numbers[k];
          }
          factors.push_back(factors_of(patch, of_patch));
        }
      }

      double
      square_of_bound(const unsigned int patch, const unsigned int point) const
      {
        if (!bound_poses[patch])
          return 0.;
        const Matrix F = fe_space.deformation_gradient(point, poses.pose(*bound_poses[patch]));
        return contract(F, F);
      }

      /// The derivatives of a patch's potential by its sums, and how they change.
      PatchTerm
      factors_of(const unsigned int patch, const PatchTerm &of_patch)
      {
        PatchSums<OfPatch> seeded_sums;
        for (std::size_t k = 0; k < PatchTerm::size; ++k)
        {
          seeded_sums.numbers[k]       = constant<OfPatch>(of_patch.numbers[k]);
          seeded_sums.numbers[k].by[k] = 1.;
        }
        const auto       law = traits_of(laws[fe_space.cell_of(patches.points(patch).front())]);
        const PatchScene of_scene{ scene.blended_part, law.has_guard_of_patches(), law.knows_volume,
                                   problem.body.material.has_elasticity_of_examples() };
        const OfPatch    potential = patch_potential(
               of_scene, seeded_sums, seeded<OfPatch>(scene.examples.importance, PatchTerm::size));
        sums.by_importance += potential.change_by[PatchTerm::size];
        PatchTerm result;
        for (std::size_t k = 0; k < PatchTerm::size; ++k)
          result.numbers[k] = Changing(potential.by[k], potential.change_by[k]);
        return result;
      }

      /// With what its patch makes of it.
      OfPoint
      whole_potential(const unsigned int point, const PointPotential<OfPoint> &found) const
      {
        OfPoint potential = found.own;
        if (patches.size() == 0)
          return potential;
        const unsigned int patch   = patches.of_point(point);
        const PatchTerm   &factor  = factors[patch];
        const auto         n_bound = static_cast<std::size_t>(PatchSum::bound);
        for (std::size_t k = 0; k < n_bound; ++k)
          potential += constant<OfPoint>(factor.numbers[k]) * found.of_patch.numbers[k];
        potential
            += constant<OfPoint>(factor.numbers[n_bound]) * OfPoint(square_of_bound(patch, point));
        return potential;
      }

      void
      add_point(const unsigned int point)
      {
        const PointPotential<OfPoint> found     = potential_of<OfPoint>(point);
        const OfPoint                 potential = whole_potential(point, found);
        const double                  V         = fe_space.volume(point);
        const unsigned int            cell      = fe_space.cell_of(point);
        const Matrix F    = fe_space.deformation_gradient(point, problem.state.positions);
        const Matrix dF   = fe_space.deformation_gradient(point, direction.positions);
        const Matrix by_F = matrix_of(potential.change_by), by_dF = matrix_of(potential.by);
        add_forces(fe_space, point, times(V, by_F), sums.by_positions);
        Matrix by_gradients = combine(V, transpose_times(F, by_F), V, transpose_times(dF, by_dF));
        add_examples(point, times(V, symmetric_matrix_of(potential.change_by)),
                     times(V, symmetric_matrix_of(potential.by)), by_gradients);
        sums.by_young[cell] += V * potential.change_by[of_E];
        sums.by_poisson[cell] += V * potential.change_by[of_nu];
        sums.by_importance += V * potential.change_by[of_eta];
        by_guard_bound += V * found.by_guard_bound.change;
        add_at_vertices(fe_space, cell,
                        combine(V * potential.change, identity_matrix<double>(), -1., by_gradients),
                        sums.by_rest_positions);
      }

      /// By weights and poses, of the slope's derivatives by the wish and by its change; adds what follows
      /// from the gradients of shape functions in the poses.
      void
      add_examples(const unsigned int point,
                   const Matrix      &by_wish,
                   const Matrix      &by_change,
                   Matrix            &by_gradients)
      {
        const std::vector<double> &w = problem.state.weights, &b = direction.weights;
        std::vector<Matrix>        by_strains(poses.size(), Matrix{});
        poses.for_each_weight(
            point,
            [&](const unsigned int weight, const unsigned int i, const double share)
            {
              sums.by_weights[weight] += share * contract(strains.strain(point, i), by_wish);
              by_strains[i] = combine(1., by_strains[i], share,
                                      combine(w[weight], by_wish, b[weight], by_change));
            });
        for (unsigned int i = 0; i < poses.size(); ++i)
          if (poses.is_strained(i))
            add_pose(point, i, by_strains[i], by_gradients);
      }

      void
      add_pose(const unsigned int point,
               const unsigned int i,
               const Matrix      &by_strain,
               Matrix            &by_gradients)
      {
        const Matrix F    = fe_space.deformation_gradient(point, poses.pose(i));
        Matrix       by_F = strains.pulled_back(point, i, by_strain);
        if (patches.size() > 0)
          if (const unsigned int patch = patches.of_point(point); bound_poses[patch] == i)
            by_F = combine(1., by_F,
                           2. * fe_space.volume(point) * factors[patch][PatchSum::bound].change, F);
        add_forces(fe_space, point, by_F, sums.by_poses[i]);
        by_gradients = combine(1., by_gradients, 1., transpose_times(F, by_F));
      }

      /// p_0 of Eq. (16) follows from the example that it must leave as it is.
      void
      add_guard_bound()
      {
        const auto where = strains.place_of_guard_bound();
        if (!where)
          return;
        const Matrix by_strain
            = times(0.5 * by_guard_bound, p_derivative(strains.stretch(where->point, where->pose)));
        const Matrix by_F = strains.pulled_back(where->point, where->pose, by_strain);
        const Matrix F    = fe_space.deformation_gradient(where->point, poses.pose(where->pose));
        add_forces(fe_space, where->point, by_F, sums.by_poses[where->pose]);
        add_at_vertices(fe_space, fe_space.cell_of(where->point),
                        times(-1., transpose_times(F, by_F)), sums.by_rest_positions);
      }

      const Problem                           &problem;
      const Direction                         &direction;
      const FESpace                           &fe_space;
      const Patches                           &patches;
      const ExamplePoses                      &poses;
      const LawsOfCells                        laws;
      const PointScene                         scene;
      const ExampleStrains                     strains;
      std::vector<PatchTerm>                   factors;     ///< of each patch
      std::vector<std::optional<unsigned int>> bound_poses; ///< of each patch
      double                                   by_guard_bound = 0.;
      SlopeDerivatives                         sums;
    };
  } // namespace

  SlopeDerivatives
  derivatives_of_slope(const Problem &problem, const Direction &direction)
  {
    SlopeDerivatives sums = Slope(problem, direction).take();
    add_slope_of_ridge(problem, direction, sums);
    add_slope_of_loads(problem, direction, sums);
    return sums;
  }
} // namespace Exemplar
