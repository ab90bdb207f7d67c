// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/cell_model.h>
#include <exemplar/run/adjoint/slope_of_motion.h>
#include <exemplar/run/adjoint/slope_terms.h>

// With s = b gamma, d = e - e_star and de the change of the strain e along a, the slope of damping is
//
//   s sum V d:C:de + s sum_p V_p lambda_p theta_p(d) theta_p(de),
//
// where theta_p is the mean of the trace over a patch, and lambda = 0 in the cells of patches.

namespace Exemplar
{
  namespace
  {
    using Matrix = Matrix3<double>;
    using Cell   = CorotationalCell<double>;

    Matrix
    add_pressure(const Matrix &A, const double p)
    {
      return combine(1., A, p, identity_matrix<double>());
    }

    /// The derivative of a cell's elasticity by Poisson's ratio.
    CellMaterial<double>
    elasticity_by_poisson(const Material &material, const unsigned int point)
    {
      const CellMaterial<double> C  = material.elasticity(point);
      const double               nu = 0.5 * C.lambda / (C.lambda + C.mu), lateral = 1. - 2. * nu;
      return { material.youngs_modulus(point) * (1. + 2. * nu * nu)
                   / ((1. + nu) * (1. + nu) * lateral * lateral),
               -C.mu / (1. + nu) };
    }

    /// A cell where the slope is taken.
    struct MovingCell
    {
      double volume;
      Matrix F, dF, R;
      Cell   cell; ///< with the target e_star, so that its stress is C:d
      Matrix d, de;
    };

    /// sum V tr over a patch, of d and of de.
    struct RateSums
    {
      double d = 0., de = 0.;
    };

    class SlopeOfDamping
    {
    public:
      SlopeOfDamping(const Problem &problem, const State &start, const Direction &direction)
          : problem(problem), direction(direction), integrator(*problem.actions.integrator),
            fe_space(problem.body.fe_space), material(problem.body.material),
            patches(problem.body.patches), history(integrator.history(start)),
            s(integrator.stiffness_damping_factor())
      {
        of_patches.assign(patches.size(), {});
        for (unsigned int patch = 0; patch < patches.size(); ++patch)
          for (const unsigned int point : patches.points(patch))
          {
            const MovingCell here = at(point);
            of_patches[patch].d += here.volume * trace(here.d);
            of_patches[patch].de += here.volume * trace(here.de);
          }
      }

      /// Without s.
      double
      unit_slope() const
      {
        double sum = 0.;
        for (unsigned int point = 0; point < fe_space.n_points(); ++point)
          sum += own_slope(at(point), elasticity(point));
        for (unsigned int patch = 0; patch < patches.size(); ++patch)
          sum += patches.lambda(patch) / patches.volume(patch) * of_patches[patch].d
                 * of_patches[patch].de;
        return sum;
      }

      void
      add_to(SlopeDerivatives &sums, MotionDerivatives &of_motion) const
      {
        of_motion.by_past.assign(history.size(), Vector(fe_space.n_dofs()));
        for (unsigned int point = 0; point < fe_space.n_points(); ++point)
        {
          const MovingCell here     = at(point);
          const Pressures  of_patch = pressures(point);
          add_material(point, here, of_patch, sums);
          Matrix by_gradients = add_deformation(point, here, of_patch, sums);
          add_past(point, here, of_patch, of_motion, by_gradients);
          add_forces(fe_space, point,
                     add_pressure(combine(-1., by_gradients, 0., by_gradients),
                                  by_volume(point, here, of_patch)),
                     sums.by_rest_positions);
        }
      }

    private:
      const CellMaterial<double>
      elasticity(const unsigned int point) const
      {
        return problem.body.cell_material.elasticity(point);
      }

      Cell
      cell(const unsigned int point, const Matrix &R, const Matrix &F) const
      {
        return Cell(elasticity(point), R, F, problem.examples.poses.constants());
      }

      MovingCell
      at(const unsigned int point) const
      {
        const Matrix F  = fe_space.deformation_gradient(point, problem.state.positions);
        const Matrix dF = fe_space.deformation_gradient(point, direction.positions);
        const Matrix R  = closest_rotation(F);
        Matrix       e_star{};
        for (const WeightedPositions &past : history)
        {
          const Matrix F_past = fe_space.deformation_gradient(point, *past.positions);
          e_star              = combine(1., e_star, past.weight,
                                        corotated_strain(closest_rotation(F_past), F_past));
        }
        MovingCell here{ fe_space.volume(point),
                         F,
                         dF,
                         R,
                         cell(point, R, F),
                         combine(1., corotated_strain(R, F), -1., e_star),
                         {} };
        here.cell.set_target(e_star);
        const Matrix M = transpose_times(R, dF);
        here.de
            = symmetric_part(combine(1., M, -1., here.cell.turn(M) * here.cell.stretch_factor()));
        return here;
      }

      double
      own_slope(const MovingCell &here, const CellMaterial<double> &C) const
      {
        return here.volume * contract(stress(C, here.d), here.de);
      }

      /// lambda_p theta_p of d and of de, and the derivative of the slope by lambda_p over V_p, without s.
      struct Pressures
      {
        double d = 0., de = 0., by_lambda = 0., mean_lambda = 0.;
      };

      Pressures
      pressures(const unsigned int point) const
      {
        if (patches.size() == 0)
          return {};
        const unsigned int patch  = patches.of_point(point);
        const RateSums    &sum    = of_patches[patch];
        const double       volume = patches.volume(patch), lambda = patches.lambda(patch);
        return { lambda / volume * sum.d, lambda / volume * sum.de,
                 sum.d * sum.de / (volume * volume), lambda };
      }

      void
      add_material(const unsigned int point,
                   const MovingCell  &here,
                   const Pressures   &of_patch,
                   SlopeDerivatives  &sums) const
      {
        const double               E          = material.youngs_modulus(point);
        const double               of_patches = here.volume * of_patch.by_lambda;
        const CellMaterial<double> by_nu      = elasticity_by_poisson(material, point);
        sums.by_young[point] += s
                                * (own_slope(here, elasticity(point))
                                   + material.elasticity(point).lambda * of_patches)
                                / E;
        sums.by_poisson[point] += s
                                  * (patches.size() == 0 ? own_slope(here, by_nu)
                                                         : by_nu.lambda * of_patches
                                                               + own_slope(here, { 0., by_nu.mu }));
      }

      /// By the positions at the end; returns F^T dslope/dF summed over F and dF.
      Matrix
      add_deformation(const unsigned int point,
                      const MovingCell  &here,
                      const Pressures   &of_patch,
                      SlopeDerivatives  &sums) const
      {
        Cell of_cell = here.cell;
        of_cell.add_pressure(of_patch.d);
        const double factor = s * here.volume;
        const Matrix M      = transpose_times(here.R, here.dF);
        const Matrix by_F   = here.R * add_pressure(of_cell.response(M), of_patch.de);
        const Matrix by_dF  = here.R * of_cell.force();
        add_forces(fe_space, point, combine(factor, by_F, 0., by_F), sums.by_positions);
        return combine(factor, transpose_times(here.F, by_F), factor,
                       transpose_times(here.dF, by_dF));
      }

      /// By the earlier positions, through e_star.
      void
      add_past(const unsigned int point,
               const MovingCell  &here,
               const Pressures   &of_patch,
               MotionDerivatives &of_motion,
               Matrix            &by_gradients) const
      {
        for (std::size_t i = 0; i < history.size(); ++i)
        {
          const Matrix F    = fe_space.deformation_gradient(point, *history[i].positions);
          const Matrix R    = closest_rotation(F);
          Cell         past = cell(point, R, F);
          past.set_target({});
          Matrix by_F = R * add_pressure(past.example_response(here.de), of_patch.de);
          by_F        = combine(-s * here.volume * history[i].weight, by_F, 0., by_F);
          add_forces(fe_space, point, by_F, of_motion.by_past[i]);
          by_gradients = combine(1., by_gradients, 1., transpose_times(F, by_F));
        }
      }

      /// Times the volume.
      double
      by_volume(const unsigned int point, const MovingCell &here, const Pressures &of_patch) const
      {
        double sum = own_slope(here, elasticity(point));
        if (patches.size() > 0)
          sum += here.volume
                 * (of_patch.d * trace(here.de) + of_patch.de * trace(here.d)
                    + of_patch.by_lambda
                          * (material.lambda_of_patches(point) - 2. * of_patch.mean_lambda));
        return s * sum;
      }

      const Problem                       &problem;
      const Direction                     &direction;
      const TimeIntegrator                &integrator;
      const FESpace                       &fe_space;
      const Material                      &material;
      const Patches                       &patches;
      const std::vector<WeightedPositions> history;
      const double                         s;
      std::vector<RateSums>                of_patches;
    };
  } // namespace

  void
  add_slope_of_damping(const Problem     &problem,
                       const State       &start,
                       const Direction   &direction,
                       SlopeDerivatives  &sums,
                       MotionDerivatives &of_motion)
  {
    const SlopeOfDamping slope(problem, start, direction);
    of_motion.by_stiffness_damping = problem.actions.integrator->rate_factor() * slope.unit_slope();
    if (problem.actions.integrator->stiffness_damping_factor() > 0.)
      slope.add_to(sums, of_motion);
  }
} // namespace Exemplar
