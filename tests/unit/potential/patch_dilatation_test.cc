// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_dilatation.h>

#include "body.h"
#include "stencil.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace Exemplar::Testing
{
  namespace
  {
    /// A bar with patches of linear or quadratic tetrahedra.
    class PatchDilatationTest : public testing::TestWithParam<Element>
    {
    protected:
      PatchDilatationTest() : body(box_mesh(4., 6, 1), MaterialParameters(), GetParam())
      {
        body.make_patches();
      }

      double
      strain_trace(const unsigned int point, const Vector &x) const
      {
        return trace(strain(point, x));
      }

      Matrix3<double>
      strain(const unsigned int point, const Vector &x) const
      {
        const Matrix3<double> F = body.fe_space.deformation_gradient(point, x);
        return model_strain(CellLaw::corotational, closest_rotation(F), F);
      }

      /// s/2 sum V (e - e*):C:(e - e*) of the points that are not left out and, of patches
      /// without such points, s/2 lambda_p V_p (theta_p - theta_past)^2; no cell is thin.
      double
      damping_energy(const Vector            &x,
                     const Vector            &past,
                     const std::vector<bool> &is_left_out) const
      {
        double energy = 0.;
        for (unsigned int patch = 0; patch < body.patches.size(); ++patch)
        {
          const double volume          = body.patches.volume(patch);
          double       change          = 0.;
          bool         is_any_left_out = false;
          for (const unsigned int point : body.patches.points(patch))
          {
            const double fraction = body.fe_space.volume(point) / volume;
            change += fraction * (strain_trace(point, x) - strain_trace(point, past));
            is_any_left_out = is_any_left_out || is_left_out[point];
            if (is_left_out[point])
              continue;
            const Matrix3<double> de = combine(1., strain(point, x), -1., strain(point, past));
            const auto           &C  = body.cell_material.elasticity(body.fe_space.cell_of(point));
            energy += 0.5 * s * body.fe_space.volume(point) * contract(stress(C, de), de);
          }
          if (!is_any_left_out)
            energy += 0.5 * s * body.patches.lambda(patch) * volume * change * change;
        }
        return energy;
      }

      /// The points that the guard holds at `past`.
      std::vector<bool>
      guarded_points(BodyPotential &elastic, const Vector &past) const
      {
        std::vector<bool> guarded;
        for (unsigned int point = 0; point < body.fe_space.n_points(); ++point)
        {
          const Matrix3<double> F       = body.fe_space.deformation_gradient(point, past);
          const CellBatches    &batches = elastic.get_field().get_batches();
          LawValue<double>      value;
          law_functions<double>(batches.law(point))
              .evaluate(batches.law_input(point, closest_rotation(F), F), false, value);
          guarded.push_back(value.is_guarded);
        }
        return guarded;
      }

      /// The gradient is the derivative of both energies, in a direction in which all nodes move.
      void
      expect_gradient(BodyPotential &elastic, const Vector &x) const
      {
        std::mt19937 generator(17);
        Vector       direction = body.random_positions(generator, 1.);
        direction -= body.fe_space.rest_positions();
        const auto energy = [&](const double way)
        {
          Vector moved = x;
          moved.add(way, direction);
          const ElasticEvaluation at = elastic.evaluate_at(moved);
          return at.energy + at.energy_damping;
        };
        const double slope = elastic.evaluate_at(x).gradient * direction;
        EXPECT_NEAR(Stencil(energy).derivative([](const double e) { return e; }), slope,
                    1e-7 * std::abs(slope));
      }

      static constexpr double s = 0.7; ///< of the damping

      Body           body;
      const Examples none;
    };

    INSTANTIATE_TEST_SUITE_P(, PatchDilatationTest, testing::Values(Element::P1, Element::P2));

    TEST_P(PatchDilatationTest, APatchWithAPointThatIsLeftOutIsNotDamped)
    {
      const FreeDofs          free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential           elastic(body, ModelParameters(), none, free_dofs);
      const Vector            past = body.with_mirrored_end(4. / 6.), x = body.drawn(1.1, 0.9, 1);
      const std::vector<bool> left_out   = guarded_points(elastic, past);
      const auto              n_left_out = std::count(left_out.begin(), left_out.end(), true);
      ASSERT_GT(n_left_out, 0);
      elastic.begin_step(s, { { 1., &past } });
      const double expected = damping_energy(x, past, left_out);
      EXPECT_NEAR(elastic.evaluate_at(x).energy_damping, expected, 1e-12 * expected);
      expect_gradient(elastic, x);
      // else it proves nothing
      const double with_all = damping_energy(x, past, std::vector<bool>(left_out.size(), false));
      EXPECT_GT(std::abs(with_all - expected), 0.01 * expected);
    }

    TEST_P(PatchDilatationTest, APatchThatIsStretchedFarIsDamped)
    {
      const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential  elastic(body, ModelParameters(), none, free_dofs);
      const Vector   past = body.drawn(4.5, 0.35, 2);
      // where the guard begins, and where it is whole
      for (const Vector &x : { body.drawn(2.3, 0.47, 3), body.drawn(5., 0.3, 3) })
      {
        elastic.begin_step(s, { { 1., &past } });
        const double expected
            = damping_energy(x, past, std::vector<bool>(body.fe_space.n_points(), false));
        EXPECT_NEAR(elastic.evaluate_at(x).energy_damping, expected, 1e-11 * expected);
        expect_gradient(elastic, x);
      }
    }

    TEST_P(PatchDilatationTest, ABodyThatDoesNotMoveIsNotDampedWhereItIsThin)
    {
      const FreeDofs          free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential           elastic(body, ModelParameters(), none, free_dofs);
      const Vector            x        = body.drawn(5., 0.15, 4);
      const ElasticEvaluation undamped = elastic.evaluate_at(x);
      elastic.begin_step(s, { { 1., &x } });
      ElasticEvaluation damped = elastic.evaluate_at(x);
      EXPECT_LT(damped.energy_damping, 1e-20 * undamped.energy);
      damped.gradient -= undamped.gradient;
      EXPECT_LT(damped.gradient.linfty_norm(), 1e-11 * undamped.gradient.linfty_norm());
    }

    TEST_P(PatchDilatationTest, RotationsThatAreForgottenGiveTheSameForces)
    {
      const FreeDofs          free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential           elastic(body, ModelParameters(), none, free_dofs);
      const Vector            x        = body.drawn(1.3, 0.8, 11);
      const ElasticEvaluation expected = elastic.evaluate_at(x);
      elastic.evaluate_at(body.drawn(1., 1., 12)); // others stand there
      ElasticEvaluation found;
      elastic.evaluate(x, {}, found, RotationUse::find_and_forget);
      EXPECT_NEAR(found.energy, expected.energy, 1e-13 * expected.energy);
      found.gradient -= expected.gradient;
      EXPECT_LT(found.gradient.linfty_norm(), 1e-12 * expected.gradient.linfty_norm());
    }

    TEST_P(PatchDilatationTest, AfterAStepNothingIsDamped)
    {
      const FreeDofs          free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential           elastic(body, ModelParameters(), none, free_dofs);
      const Vector            x = body.drawn(1.2, 0.9, 5), past = body.drawn(1., 1., 6);
      const ElasticEvaluation before = elastic.evaluate_at(x);
      elastic.begin_step(s, { { 1., &past } });
      EXPECT_GT(elastic.evaluate_at(x).energy_damping, 0.01 * before.energy);
      elastic.leave_step();
      const ElasticEvaluation after = elastic.evaluate_at(x);
      EXPECT_EQ(after.energy_damping, 0.);
      EXPECT_EQ(after.gradient, before.gradient);
    }

    TEST_P(PatchDilatationTest, ResponseBesideHeldNodesIsTheDerivativeByThem)
    {
      ExampleParameters parameters;
      parameters.pose_functions                 = twist(60.) + " | 1.1*x; 0.9*y; z";
      parameters.importance                     = 0.7;
      const Examples                  examples  = body.examples(parameters);
      const std::vector<double>       weights   = { 0.2, 0.5, 0.3 };
      const std::vector<unsigned int> held_dofs = { 0, 4, 8, 30 };
      const FreeDofs free_dofs(body.fe_space.n_dofs(), held_dofs, Exchange::serial());
      BodyPotential  elastic(body, ModelParameters(), examples, free_dofs);
      Vector         displacement(body.fe_space.n_dofs());
      for (const unsigned int dof : held_dofs)
        displacement[dof] = 0.1 + 0.01 * dof;
      const Vector past = body.drawn(2., 0.5, 8);
      // where the guard begins, where it is whole, and where cells are thin
      for (const Vector &x :
           { body.drawn(2.3, 0.47, 9), body.drawn(5., 0.3, 9), body.drawn(5., 0.15, 9) })
        for (const double factor : { 0., s })
        {
          elastic.begin_step(factor, { { 1., &past } });
          const auto evaluate_at = [&](const double way)
          {
            Vector moved = x;
            moved.add(way, displacement);
            return elastic.evaluate_at(moved, weights);
          };
          const Stencil           around(evaluate_at);
          const ElasticEvaluation at     = evaluate_at(0.);
          ElasticEvaluation       change = at;
          elastic.add_response(Tangent::exact, displacement, x, weights, change);
          const Vector difference = around.derivative_of_gradient();
          const double scale      = difference.linfty_norm();
          change.gradient -= at.gradient;
          change.gradient -= difference;
          EXPECT_LT(change.gradient.linfty_norm(), 1e-7 * scale);
          for (unsigned int k = 0; k < weights.size(); ++k)
            EXPECT_NEAR(
                change.weight_gradient[k] - at.weight_gradient[k],
                around.derivative([k](const ElasticEvaluation &e) { return e.weight_gradient[k]; }),
                1e-7 * scale);
        }
    }
  } // namespace
} // namespace Exemplar::Testing
