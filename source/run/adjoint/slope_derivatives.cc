// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/cell_model.h>
#include <exemplar/run/adjoint/slope_terms.h>

#include <numeric>

// The derivatives of the slope of Psi, Eqs. (5) and (25). In a cell it is
//
//   V (T : (de - dD) + pi tr(de - dD) + dpi tr(e - D))  with  T = C:(e - D),  D = eta E(w),  dD = eta E(b),
//
// where de is the change of the strain along a, and pi and dpi are the pressure of the patch and its change. Of
// the weights' own energy it has kappa V E(b):C:E(w), kappa = p eta (1 - eta), and the ridge.

namespace Exemplar
{
  namespace
  {
    using Matrix = Matrix3<double>;

    Matrix
    scaled(const double factor, const Matrix &A)
    {
      return combine(factor, A, 0., A);
    }

    /// R (Q + W), the derivative by F of S:Q, with W of Eq. (17).
    Matrix
    pull_back(const Matrix &R, const Matrix &S, const Matrix &Q)
    {
      Matrix B = combine(-1., S, 0., S);
      for (int i = 0; i < 3; ++i)
        B[i][i] += trace(S);
      const Matrix inverse = scaled(1. / determinant(B), cofactors(B));
      const Matrix W       = skew_matrix(inverse * axial_vector(commutator(S, Q)));
      return R * combine(1., Q, 1., W);
    }

    Matrix
    add_identity(Matrix A, const double factor)
    {
      for (int i = 0; i < 3; ++i)
        A[i][i] += factor;
      return A;
    }

    void
    add(Matrix &to, const double factor, const Matrix &A)
    {
      to = combine(1., to, factor, A);
    }

    /// A cell where the slope is taken.
    struct PointState
    {
      double               volume;
      CellMaterial<double> C; ///< of the cells' own energy
      Matrix               F, dF, R, S, dS;
      Matrix               wish, d_wish; ///< E(w) and E(b)
      double               eta;

      /// e - D and de - dD.
      Matrix
      strain() const
      {
        return combine(1., add_identity(S, -1.), -eta, wish);
      }

      Matrix
      d_strain() const
      {
        return combine(1., dS, -eta, d_wish);
      }
    };

    /// sum V tr over a patch, of each.
    struct PatchSums
    {
      double strain = 0., d_strain = 0., wish = 0., d_wish = 0.;
    };

    class Slope
    {
    public:
      Slope(const Problem &problem, const Direction &direction)
          : problem(problem), direction(direction), fe_space(problem.body.fe_space),
            material(problem.body.material), patches(problem.body.patches),
            poses(problem.examples.poses), eta(poses.constants().importance)
      {
        const double p = blended_part(problem.parameters.examples.energy);
        kappa          = p * eta * (1. - eta);
        d_kappa        = p * (1. - 2. * eta);
        initialize();
        find_patch_sums();
        for (unsigned int point = 0; point < fe_space.n_points(); ++point)
          add_point(point);
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

      /// sum_i w_i E_i at a point.
      Matrix
      blend(const unsigned int point, const std::vector<double> &weights) const
      {
        return weights.empty() ? Matrix{} : scaled(1. / eta, poses.strain(point, weights));
      }

      PointState
      at(const unsigned int point) const
      {
        PointState at;
        at.volume      = fe_space.volume(point);
        at.C           = problem.body.cell_material.elasticity(point);
        at.F           = fe_space.deformation_gradient(point, problem.state.positions);
        at.dF          = fe_space.deformation_gradient(point, direction.positions);
        at.R           = closest_rotation(at.F);
        at.S           = symmetric_part(transpose_times(at.R, at.F));
        at.eta         = eta;
        at.wish        = blend(point, problem.state.weights);
        at.d_wish      = blend(point, direction.weights);
        const Matrix M = transpose_times(at.R, at.dF);
        at.dS          = symmetric_part(combine(1., M, -1., cell(at).turn(M) * at.S));
        return at;
      }

      CorotationalCell<double>
      cell(const PointState &at) const
      {
        CorotationalCell<double> cell(at.C, at.R, at.F, poses.constants());
        cell.set_target(scaled(eta, at.wish));
        return cell;
      }

      void
      find_patch_sums()
      {
        of_patches.assign(patches.size(), {});
        for (unsigned int patch = 0; patch < patches.size(); ++patch)
          for (const unsigned int point : patches.points(patch))
          {
            const PointState here = at(point);
            PatchSums       &sum  = of_patches[patch];
            sum.strain += here.volume * trace(here.strain());
            sum.d_strain += here.volume * trace(here.d_strain());
            sum.wish += here.volume * trace(here.wish);
            sum.d_wish += here.volume * trace(here.d_wish);
          }
      }

      /// What a patch adds to the derivatives in its cells; nothing without patches.
      struct Pressures
      {
        double pressure = 0., d_pressure = 0.; ///< pi and dpi
        double wish = 0., d_wish = 0.;         ///< lambda_p theta_p of E(w) and of E(b)
        double by_lambda   = 0.;               ///< derivative of the slope by lambda_p over V_p
        double mean_lambda = 0.;               ///< lambda_p
      };

      Pressures
      pressures(const unsigned int point) const
      {
        if (patches.size() == 0)
          return {};
        const unsigned int patch  = patches.of_point(point);
        const PatchSums   &sum    = of_patches[patch];
        const double       volume = patches.volume(patch), lambda = patches.lambda(patch);
        const double       stiffness = lambda / volume;
        return { stiffness * sum.strain,
                 stiffness * sum.d_strain,
                 stiffness * sum.wish,
                 stiffness * sum.d_wish,
                 (sum.strain * sum.d_strain + kappa * sum.wish * sum.d_wish) / (volume * volume),
                 lambda };
      }

      void
      add_point(const unsigned int point)
      {
        const PointState here     = at(point);
        const Pressures  of_patch = pressures(point);
        // the derivatives of the slope by E(w) and E(b)
        const Matrix dT      = add_identity(stress(here.C, here.d_strain()), of_patch.d_pressure);
        const Matrix T       = add_identity(stress(here.C, here.strain()), of_patch.pressure);
        const Matrix by_wish = combine(kappa * here.volume,
                                       add_identity(stress(here.C, here.d_wish), of_patch.d_wish),
                                       -eta * here.volume, dT);
        const Matrix by_d_wish
            = combine(kappa * here.volume, add_identity(stress(here.C, here.wish), of_patch.wish),
                      -eta * here.volume, T);
        if (poses.size() > 0)
          sums.by_importance
              += d_kappa * here.volume
                     * contract(here.d_wish, add_identity(stress(here.C, here.wish), of_patch.wish))
                 - here.volume * (contract(dT, here.wish) + contract(T, here.d_wish));
        Matrix by_gradients = add_deformation(point, here, of_patch);
        add_examples(point, by_wish, by_d_wish, by_gradients);
        add_material(point, here, of_patch);
        add_rest(point, here, of_patch, by_gradients);
      }

      /// By the positions; returns F^T dslope/dF summed over F and dF.
      Matrix
      add_deformation(const unsigned int point, const PointState &here, const Pressures &of_patch)
      {
        CorotationalCell<double> of_cell = cell(here);
        of_cell.add_pressure(of_patch.pressure);
        const Matrix M       = transpose_times(here.R, here.dF);
        const Matrix of_wish = pull_back(here.R, here.S, stress(here.C, here.d_wish));
        Matrix       by_F    = here.R * add_identity(of_cell.response(M), of_patch.d_pressure);
        add(by_F, -eta, of_wish);
        const Matrix by_dF = here.R * of_cell.force();
        add_forces(fe_space, point, scaled(here.volume, by_F), sums.by_positions);
        return combine(here.volume, transpose_times(here.F, by_F), here.volume,
                       transpose_times(here.dF, by_dF));
      }

      /// By weights and poses; adds F_i^T dslope/dF_i to `by_gradients`.
      void
      add_examples(const unsigned int point,
                   const Matrix      &by_wish,
                   const Matrix      &by_d_wish,
                   Matrix            &by_gradients)
      {
        const std::vector<double> &w = problem.state.weights, &b = direction.weights;
        std::vector<Matrix>        by_strains(poses.size(), Matrix{});
        poses.for_each_weight(
            point,
            [&](const unsigned int weight, const unsigned int i, const double share)
            {
              sums.by_weights[weight] += share / eta * contract(poses.strain(point, i), by_wish);
              add(by_strains[i], share * w[weight], by_wish);
              add(by_strains[i], share * b[weight], by_d_wish);
            });
        for (unsigned int i = 0; i < poses.size(); ++i)
        {
          if (!poses.is_strained(i))
            continue;
          const Matrix F    = fe_space.deformation_gradient(point, poses.pose(i));
          const Matrix R    = closest_rotation(F);
          const Matrix by_F = pull_back(R, symmetric_part(transpose_times(R, F)), by_strains[i]);
          add_forces(fe_space, point, by_F, sums.by_poses[i]);
          add(by_gradients, 1., transpose_times(F, by_F));
        }
      }

      /// V (e - D):C:(de - dD) + kappa V E(w):C:E(b) for this C.
      double
      own_slope(const PointState &here, const CellMaterial<double> &C) const
      {
        return here.volume
               * (contract(stress(C, here.strain()), here.d_strain())
                  + kappa * contract(stress(C, here.wish), here.d_wish));
      }

      void
      add_material(const unsigned int point, const PointState &here, const Pressures &of_patch)
      {
        const CellMaterial<double> all = material.elasticity(point);
        const double               E   = material.youngs_modulus(point);
        const double         nu = 0.5 * all.lambda / (all.lambda + all.mu), lateral = 1. - 2. * nu;
        CellMaterial<double> by_nu{
          E * (1. + 2. * nu * nu) / ((1. + nu) * (1. + nu) * lateral * lateral), -all.mu / (1. + nu)
        };
        const double of_patches = here.volume * of_patch.by_lambda;
        sums.by_young[point] += (own_slope(here, here.C) + all.lambda * of_patches) / E;
        sums.by_poisson[point] += by_nu.lambda * of_patches;
        if (patches.size() > 0)
          by_nu.lambda = 0.;
        sums.by_poisson[point] += own_slope(here, by_nu);
      }

      /// By the rest positions, on which the volumes and the gradients of shape functions depend.
      void
      add_rest(const unsigned int point,
               const PointState  &here,
               const Pressures   &of_patch,
               const Matrix      &by_gradients)
      {
        double by_volume = own_slope(here, here.C); // times the volume
        if (patches.size() > 0)
        {
          by_volume += here.volume
                       * (of_patch.pressure * trace(here.d_strain())
                          + of_patch.d_pressure * trace(here.strain())
                          + kappa
                                * (of_patch.wish * trace(here.d_wish)
                                   + of_patch.d_wish * trace(here.wish)));
          // of the patch's volume, and of its lambda, which is a mean over the volumes
          by_volume += here.volume * of_patch.by_lambda
                       * (material.lambda_of_patches(point) - 2. * of_patch.mean_lambda);
        }
        add_forces(fe_space, point, add_identity(scaled(-1., by_gradients), by_volume),
                   sums.by_rest_positions);
      }

      const Problem         &problem;
      const Direction       &direction;
      const FESpace         &fe_space;
      const Material        &material;
      const Patches         &patches;
      const ExamplePoses    &poses;
      const double           eta;
      double                 kappa, d_kappa; ///< kappa and its derivative by eta
      std::vector<PatchSums> of_patches;
      SlopeDerivatives       sums;
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
