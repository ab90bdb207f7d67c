// SPDX-License-Identifier: GPL-3.0-or-later
#include "body.h"
#include "matrices.h"
#include "stencil.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// A neo-Hookean bar in patches.
    class NeoHookeanPatchesTest : public testing::TestWithParam<Element>
    {
    protected:
      NeoHookeanPatchesTest() : body(box_mesh(4., 4, 1), MaterialParameters(), GetParam())
      {
        body.make_patches();
      }

      /// Eq. (34) of the points' own J and of the means, as it is published, less that of the rest pose.
      double
      expected_energy(const Vector &x) const
      {
        double sum = 0.;
        for (unsigned int patch = 0; patch < body.patches.size(); ++patch)
        {
          double of_patch = 0.;
          for (const unsigned int point : body.patches.points(patch))
          {
            const Matrix3<double> F   = body.fe_space.deformation_gradient(point, x);
            const double          I_C = contract(F, F), J = determinant(F);
            const double          mu  = body.material.elasticity(body.fe_space.cell_of(point)).mu;
            const double          psi = 2. / 3. * mu * (I_C - 3. - std::log(0.25 * (I_C + 1.)))
                               + 5. / 12. * mu * ((J - 2.2) * (J - 2.2) - 1.44);
            sum += body.fe_space.volume(point) * psi;
            of_patch += body.fe_space.volume(point) * (J - 1.);
          }
          sum += 0.5 * body.patches.lambda(patch) * of_patch * of_patch
                 / body.patches.volume(patch);
        }
        return sum;
      }

      Body           body;
      const Examples none;
    };

    INSTANTIATE_TEST_SUITE_P(, NeoHookeanPatchesTest, testing::Values(Element::P1, Element::P2));

    TEST_P(NeoHookeanPatchesTest, EnergyIsThatOfTheMeansOfJ)
    {
      const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential  elastic(body, LawsOfCells(CellLaw::neo_hookean), none, free_dofs);
      for (const Vector &x : { body.drawn(1.3, 0.9, 1), body.drawn(3., 0.5, 2),
                               body.drawn(5., 0.15, 3), body.with_mirrored_end(1.) })
      {
        const ElasticEvaluation at       = elastic.evaluate_at(x);
        const double            expected = expected_energy(x);
        EXPECT_NEAR(at.energy, expected, 1e-12 * expected);
        EXPECT_NEAR(at.energy_elastic, expected, 1e-12 * expected);
        const CellResults results = elastic.cell_results(x, {});
        double            sum     = 0.;
        for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
          sum += body.fe_space.cell_volume(cell) * results.strain_energy_density[cell];
        EXPECT_NEAR(sum, expected, 1e-12 * expected);
      }
    }

    TEST_P(NeoHookeanPatchesTest, TheSameStrainEverywhereHasTheEnergyAndForcesOfCells)
    {
      const Body        of_cells(box_mesh(4., 4, 1), MaterialParameters(), GetParam());
      const FreeDofs    free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      const LawsOfCells law(CellLaw::neo_hookean);
      BodyPotential elastic(body, law, none, free_dofs), cellwise(of_cells, law, none, free_dofs);
      std::mt19937  generator(3);
      const Matrix3<double> F
          = combine(1., identity_matrix<double>(), 0.3, random_matrix(generator));
      Vector x = body.fe_space.rest_positions();
      for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
      {
        const Vector3<double> X = { { x[3 * node], x[3 * node + 1], x[3 * node + 2] } };
        for (unsigned int c = 0; c < 3; ++c)
          x[3 * node + c] = (F * X)[c];
      }
      ElasticEvaluation       at       = elastic.evaluate_at(x);
      const ElasticEvaluation expected = cellwise.evaluate_at(x);
      EXPECT_NEAR(at.energy, expected.energy, 1e-12 * expected.energy);
      at.gradient -= expected.gradient;
      EXPECT_LT(at.gradient.linfty_norm(), 1e-12 * expected.force_scale.linfty_norm());
    }

    TEST_P(NeoHookeanPatchesTest, RestIsFreeOfForce)
    {
      const FreeDofs          free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential           elastic(body, LawsOfCells(CellLaw::neo_hookean), none, free_dofs);
      const ElasticEvaluation at = elastic.evaluate_at(body.fe_space.rest_positions());
      EXPECT_LT(at.energy, 1e-20 * 1e6);
      EXPECT_LT(at.gradient.linfty_norm(), 1e-9 * 1e6);
    }

    /// What `displacement` changes of the forces, by a tangent.
    Vector
    response(BodyPotential &elastic,
             const Tangent  kind,
             const Vector  &x,
             const Vector  &displacement)
    {
      const ElasticEvaluation at     = elastic.evaluate_at(x);
      ElasticEvaluation       change = at;
      elastic.add_response(kind, displacement, x, {}, change);
      change.gradient -= at.gradient;
      return change.gradient;
    }

    TEST_P(NeoHookeanPatchesTest, SmallStrainsAreThoseOfTheCorotationalBody)
    {
      std::vector<unsigned int> held;
      for (unsigned int dof = 0; dof < body.fe_space.n_dofs(); ++dof)
        held.push_back(dof);
      held.pop_back();
      const FreeDofs free_dofs(body.fe_space.n_dofs(), held, Exchange::serial());
      BodyPotential  elastic(body, LawsOfCells(CellLaw::neo_hookean), none, free_dofs);
      BodyPotential  corotational(body, LawsOfCells(CellLaw::corotational), none, free_dofs);
      std::mt19937   generator(4);
      const Vector   rest         = body.fe_space.rest_positions();
      Vector         displacement = body.random_positions(generator, 1.);
      displacement -= rest;
      for (const unsigned int dof : free_dofs.list())
        displacement[dof] = 0.;
      const Vector expected = response(corotational, Tangent::exact, rest, displacement);
      for (const Tangent kind : { Tangent::exact, Tangent::convex })
      {
        Vector own = response(elastic, kind, rest, displacement);
        own -= expected;
        EXPECT_LT(own.linfty_norm(), 1e-12 * expected.linfty_norm());
      }
    }

    // With and without damping and examples; stretched, thin, and with an inverted end.
    TEST_P(NeoHookeanPatchesTest, ForcesAndTangentsAreDerivatives)
    {
      std::vector<unsigned int> held;
      for (unsigned int dof = 0; dof < body.fe_space.n_dofs(); dof += 2)
        held.push_back(dof);
      const FreeDofs    free_dofs(body.fe_space.n_dofs(), held, Exchange::serial());
      ExampleParameters parameters;
      parameters.pose_functions = twist(60.) + " | 1.1*x; 0.9*y; z";
      const Vector past         = body.drawn(1.1, 0.9, 5);
      for (const double importance : { 0., 0.6 })
        for (const double damping : { 0., 0.7 })
        {
          parameters.importance = importance;
          const Examples examples
              = importance > 0. ? body.examples(parameters, CellLaw::neo_hookean) : Examples();
          const std::vector<double> weights
              = importance > 0. ? std::vector<double>{ 0.2, 0.5, 0.3 } : std::vector<double>();
          BodyPotential elastic(body, LawsOfCells(CellLaw::neo_hookean), examples, free_dofs);
          elastic.begin_step(damping, { { 1., &past } });
          for (const Vector &x : { body.drawn(1.3, 0.9, 1), body.drawn(2.3, 0.47, 2),
                                   body.drawn(5., 0.3, 3), body.drawn(5., 0.15, 4) })
          {
            Vector displacement(body.fe_space.n_dofs());
            for (const unsigned int dof : held)
              displacement[dof] = std::sin(3. * dof);
            const auto at = [&](const double way)
            {
              Vector moved = x;
              moved.add(way, displacement);
              return elastic.evaluate_at(moved, weights);
            };
            const Stencil           around(at);
            const ElasticEvaluation here  = at(0.);
            const double            slope = here.gradient * displacement;
            EXPECT_NEAR(around.derivative([](const ElasticEvaluation &e)
                                          { return e.energy + e.energy_damping; }),
                        slope, 1e-7 * std::abs(slope));
            const Vector      difference = around.derivative_of_gradient();
            ElasticEvaluation change     = here;
            elastic.add_response(Tangent::exact, displacement, x, weights, change);
            change.gradient -= here.gradient;
            change.gradient -= difference;
            EXPECT_LT(change.gradient.linfty_norm(), 1e-7 * difference.linfty_norm());
          }
        }
    }
  } // namespace
} // namespace Exemplar::Testing
