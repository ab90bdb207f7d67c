// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/slope_of_contact.h>
#include <exemplar/run/adjoint/slope_of_points.h>
#include <exemplar/run/adjoint/slope_of_shell.h>

#include <algorithm>

// The slope of Psi, Eqs. (5), (25), (26), (37) and (38).

namespace Exemplar
{
  namespace
  {
    /// The elastic part of a slope: the target of a point is the blend of the examples' strains.
    class ElasticPart
    {
    public:
      template <typename Cell, typename Number>
      using Evaluation = ElasticPoint<Cell, Number>;

      static constexpr bool is_damping = false;

      ElasticPart(const Problem             &problem,
                  const ExampleStrains      &strains,
                  const std::vector<double> &along)
          : problem(problem), along(along), fe_space(problem.body.fe_space),
            patches(problem.body.patches), poses(problem.examples.poses), strains(strains),
            has_volume_terms(patches.size() > 0
                             && std::any_of(strains.get_laws().present().begin(),
                                            strains.get_laws().present().end(),
                                            [](const CellLaw law)
                                            { return traits_of(law).has_volumetric_energy; }))
      {
      }

      const LawsOfCells &
      get_laws() const
      {
        return strains.get_laws();
      }

      static double
      share(const unsigned int /*point*/)
      {
        return 1.;
      }

      static double
      share_of_patch(const unsigned int /*patch*/)
      {
        return 1.;
      }

      bool
      is_of_law_alone() const
      {
        const ExampleParameters &examples = problem.parameters.examples;
        return !has_volume_terms
               && (!has_targets()
                   || (examples.acts_on == ActsOn::all && !(blended_part(examples.energy) > 0.)
                       && !problem.body.material.has_elasticity_of_examples()));
      }

      bool
      has_targets() const
      {
        return poses.size() > 0;
      }

      /// Whether the target's trace may be extended, as that of the strain.
      static bool
      may_be_thin(const unsigned int /*point*/)
      {
        return false;
      }

      double
      target_factor(const unsigned int cell) const
      {
        return problem.body.material.importance(cell) * poses.constants().importance;
      }

      MatrixAlong
      target(const unsigned int point) const
      {
        const MatrixAlong of     = wish(point);
        const double      factor = target_factor(fe_space.cell_of(point));
        return { times(factor, of.value), times(factor, of.change) };
      }

      /// To which targets are proportional.
      double
      by_importance(const double by_targets_size) const
      {
        return by_targets_size / poses.constants().importance;
      }

      MatrixAlong
      wish(const unsigned int point) const
      {
        return { strains.wish(point, problem.state.weights), strains.wish(point, along) };
      }

      PatchScene
      patch_scene(const PointScene &scene, const ModelTraits &law) const
      {
        return { scene.blended_part, law.has_guard_of_patches(), law.has_volumetric_energy,
                 problem.body.material.has_elasticity_of_examples() };
      }

      double
      square_of_bound(const unsigned int patch, const unsigned int point) const
      {
        const auto pose = strains.pose_of_bound(patch);
        if (!pose)
          return 0.;
        const Matrix3<double> F = fe_space.deformation_gradient(point, poses.pose(*pose));
        return contract(F, F);
      }

      /// Adds derivatives by weights, examples' strains, and poses that set bounds of the patches'
      /// guards.
      void
      add_wish(const unsigned int  point,
               const MatrixAlong  &by_wish,
               const PatchFactors *factors,
               SlopeDerivatives   &sums,
               Matrix3<double>    &by_gradients) const
      {
        const std::vector<double>     &w     = problem.state.weights;
        const SymmetricEntries<double> value = pack(by_wish.value), change = pack(by_wish.change);
        poses.get_strains().for_each_weight(
            point,
            [&](const unsigned int weight, const unsigned int i, const double share)
            {
              sums.by_weights[weight] += share * contract(strains.strain(point, i), by_wish.value);
              SymmetricEntries<double> &by_strain = sums.by_strains[point * poses.size() + i];
              for (std::size_t k = 0; k < n_symmetric; ++k)
                by_strain[k] += share * (w[weight] * value[k] + along[weight] * change[k]);
            });
        if (factors == nullptr)
          return;
        if (const auto pose = strains.pose_of_bound(patches.of_point(point)))
          add_bound(point, *pose, (*factors)[PatchSum::bound].by[0], sums, by_gradients);
      }

      void
      add_guard_bound(const double by_bound, SlopeDerivatives &sums) const
      {
        add_slope_of_guard_bound(problem, strains, by_bound, sums);
      }

    private:
      void
      add_bound(const unsigned int point,
                const unsigned int pose,
                const double       by_bound,
                SlopeDerivatives  &sums,
                Matrix3<double>   &by_gradients) const
      {
        const Matrix3<double> F    = fe_space.deformation_gradient(point, poses.pose(pose));
        const Matrix3<double> by_F = times(2. * fe_space.volume(point) * by_bound, F);
        add_forces(fe_space, point, by_F, sums.by_poses[pose]);
        by_gradients = combine(1., by_gradients, 1., transpose_times(F, by_F));
      }

      const Problem             &problem;
      const std::vector<double> &along;
      const FESpace             &fe_space;
      const Patches             &patches;
      const ExamplePoses        &poses;
      const ExampleStrains      &strains;
      const bool                 has_volume_terms; ///< of patches, Eq. (37)
    };

    SlopeDerivatives
    no_derivatives(const Problem &problem)
    {
      SlopeDerivatives    sums;
      const ExamplePoses &poses = problem.examples.poses;
      const unsigned int  n = problem.body.fe_space.n_dofs(), m = problem.body.fe_space.n_cells();
      for (Vector *field : { &sums.by_positions, &sums.by_rest_positions, &sums.by_nodal_forces })
        field->reinit(n);
      sums.by_weights.assign(poses.n_weights(), 0.);
      sums.by_poses.assign(poses.size(), Vector(n));
      sums.by_strains.assign(problem.body.fe_space.n_points() * poses.size(), {});
      sums.by_gradients.assign(m, {});
      sums.by_constants.assign(m, {});
      for (auto *cells : { &sums.by_young, &sums.by_poisson, &sums.by_density })
        cells->assign(m, 0.);
      if (problem.body.fe_space.is_shell())
        sums.by_thickness.assign(m, 0.);
      return sums;
    }

    /// By Young's modulus, Poisson's ratio and eta, from those by lambda and mu.
    void
    carry_constants_to_moduli(const Problem &problem, SlopeDerivatives &sums)
    {
      using Number            = OfPoint::Regular;
      const Body        &body = problem.body;
      const BodyMaterial material{ body.material, body.cell_material,
                                   problem.parameters.examples.acts_on, body.patches.size() > 0 };
      const LawsOfCells  laws = laws_of_cells(problem.parameters, body);
      const Number       eta
          = OfPoint::seeded<Number>(problem.examples.poses.constants().importance, OfPoint::eta);
      for (unsigned int cell = 0; cell < sums.by_constants.size(); ++cell)
      {
        const PointElasticity<Number> of(material, cell, eta);
        const auto                    C          = of.of_law<Isotropic<Number>>(laws[cell]);
        const Number                  of_patches = of.lambda_of_patches();
        const auto                    by         = [&](const std::size_t k)
        {
          double sum = 0.;
          for (std::size_t i = 0; i < LawSlope<double>::n_constants; ++i)
            sum += sums.by_constants[cell][i] * C.number(i).by[k];
          return sum + sums.by_constants[cell][LawSlope<double>::n_constants] * of_patches.by[k];
        };
        sums.by_young[cell] += by(OfPoint::E);
        sums.by_poisson[cell] += by(OfPoint::nu);
        sums.by_importance += by(OfPoint::eta);
      }
      sums.by_constants.clear();
    }
  } // namespace

  SlopeDerivatives
  derivatives_of_slope(Problem &problem, const ExampleStrains &strains, const Direction &direction)
  {
    SlopeDerivatives sums = no_derivatives(problem);
    if (problem.body.fe_space.is_shell())
      add_slope_of_shell(problem, direction, sums);
    else
    {
      ElasticPart part(problem, strains, direction.weights);
      SlopeOfPoints<ElasticPart>(problem, direction.positions, part).add_to(sums);
    }
    add_slope_of_ridge(problem, direction, sums);
    add_slope_of_loads(problem, direction, sums);
    add_slope_of_contact(problem, direction, sums);
    add_slope_of_tension(problem, direction, sums);
    return sums;
  }

  void
  carry_to_parameters(const Problem &problem, SlopeDerivatives &sums)
  {
    if (problem.body.fe_space.is_shell())
    {
      carry_to_shell(problem, sums);
      return;
    }
    carry_strains_to_poses(problem, sums);
    carry_constants_to_moduli(problem, sums);
    for (unsigned int cell = 0; cell < sums.by_gradients.size(); ++cell)
      add_at_vertices(problem.body.fe_space, cell, sums.by_gradients[cell], sums.by_rest_positions);
    sums.by_gradients.clear();
  }

  void
  add_slope_of_guard_bound(const Problem        &problem,
                           const ExampleStrains &strains,
                           const double          by_bound,
                           SlopeDerivatives     &sums)
  {
    const auto where = strains.place_of_guard_bound();
    if (!where)
      return;
    const auto [point, pose]       = *where;
    const FESpace        &fe_space = problem.body.fe_space;
    const Matrix3<double> by_strain
        = times(0.5 * by_bound, p_derivative(strains.stretch(point, pose)));
    const Matrix3<double> F
        = fe_space.deformation_gradient(point, problem.examples.poses.pose(pose));
    const Matrix3<double> by_F
        = pulled_back(strains.get_laws()[fe_space.cell_of(point)], F, by_strain);
    add_forces(fe_space, point, by_F, sums.by_poses[pose]);
    add_at_vertices(fe_space, fe_space.cell_of(point), times(-1., transpose_times(F, by_F)),
                    sums.by_rest_positions);
  }
} // namespace Exemplar
