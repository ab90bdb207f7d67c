// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/potential/elastic_potential.h>

#include "body.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace Exemplar::Testing
{
  namespace
  {
    /// The exact and the convex tangent of a bar of which some degrees of freedom are held.
    class TangentsTest : public testing::TestWithParam<Discretisation>
    {
    protected:
      TangentsTest() : body(box_mesh(4., 4, 1), MaterialParameters(), GetParam().element)
      {
        if (GetParam().has_patches)
          body.make_patches();
      }

      struct Matrix
      {
        std::vector<double> values, columns;
        OuterProducts       products;
      };

      static Matrix
      assemble(BodyPotential             &elastic,
               const Tangent              kind,
               const Vector              &x,
               const std::vector<double> &weights)
      {
        elastic.update_rotations(x);
        Matrix matrix;
        matrix.values.resize(elastic.matrix_pattern.n_values());
        elastic.assemble_tangent(kind, x, weights, matrix.values, matrix.columns,
                                 elastic.matrix_pattern.products_are_apart ? &matrix.products
                                                                           : nullptr);
        return matrix;
      }

      /// A u where nothing is held.
      static Vector
      product(const SymmetricPattern &pattern, const std::vector<double> &values, const Vector &u)
      {
        Vector result(u.size());
        for (unsigned int j = 0; j < u.size(); ++j)
          for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
          {
            const unsigned int i = pattern.row[k];
            result[i] += values[k] * u[j];
            if (i != j)
              result[j] += values[k] * u[i];
          }
        return result;
      }

      static void
      add_products(const OuterProducts &products, const Vector &u, Vector &result)
      {
        for (std::size_t k = 0; k < products.size(); ++k)
        {
          double sum = 0.;
          for (std::size_t entry = 3 * products.begin(k); entry < 3 * products.ends[k]; ++entry)
            sum += products.values[entry] * u[3 * products.blocks[entry / 3] + entry % 3];
          for (std::size_t entry = 3 * products.begin(k); entry < 3 * products.ends[k]; ++entry)
            result[3 * products.blocks[entry / 3] + entry % 3]
                += products.factors[k] * sum * products.values[entry];
        }
      }

      static constexpr double s = 0.7; ///< of the damping

      Body                            body;
      const Examples                  none;
      const std::vector<unsigned int> held_dofs = { 0, 4, 8, 30 };
    };

    INSTANTIATE_TEST_SUITE_P(,
                             TangentsTest,
                             testing::Values(Discretisation{ Element::P1, false },
                                             Discretisation{ Element::P2, false },
                                             Discretisation{ Element::P1, true },
                                             Discretisation{ Element::P2, true }));

    TEST_P(TangentsTest, ThePartsOfATangentAreTheWhole)
    {
      ExampleParameters parameters;
      parameters.pose_functions          = twist(60.) + " | 1.1*x; 0.9*y; z";
      const Examples            examples = body.examples(parameters, CellLaw::corotational);
      const std::vector<double> weights  = { 0.2, 0.5, 0.3 };
      const FreeDofs            free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential             whole(body, ModelParameters(), examples, free_dofs),
          parts(body, ModelParameters(), examples, free_dofs);
      parts.assemble_in_parts();
      std::mt19937 generator(7);
      const Vector u = body.random_positions(generator, 1.);
      // also where the guards of patches act, of stretched ones and of those with thin cells
      for (const Vector &x : { body.drawn(1.2, 0.9, 1), body.drawn(2.3, 0.47, 3),
                               body.drawn(5., 0.3, 3), body.with_mirrored_end(4. / 6.) })
        for (const Tangent kind : { Tangent::exact, Tangent::convex })
        {
          const Matrix expected = assemble(whole, kind, x, weights),
                       got      = assemble(parts, kind, x, weights);
          Vector of_whole       = product(whole.matrix_pattern, expected.values, u),
                 of_parts       = product(parts.matrix_pattern, got.values, u);
          add_products(got.products, u, of_parts);
          of_parts -= of_whole;
          EXPECT_LT(of_parts.linfty_norm(), 1e-12 * of_whole.linfty_norm());
          EXPECT_EQ(got.columns, expected.columns);
        }
      const bool couples_more = GetParam().has_patches && GetParam().element == Element::P1;
      EXPECT_EQ(parts.matrix_pattern.row.size() < whole.matrix_pattern.row.size(), couples_more);
    }

    TEST_P(TangentsTest, TheResponseToHeldNodesIsTheProductWithTheTangent)
    {
      ExampleParameters parameters;
      parameters.pose_functions         = twist(60.) + " | 1.1*x; 0.9*y; z";
      parameters.importance             = 0.7;
      const std::vector<double> weights = { 0.2, 0.5, 0.3 };
      std::vector<CellLaw>      laws = { CellLaw::corotational, CellLaw::frozen, CellLaw::linear };
      if (!GetParam().has_patches)
        laws.push_back(CellLaw::green);
      Vector displacement(body.fe_space.n_dofs());
      for (const unsigned int dof : held_dofs)
        displacement[dof] = 0.1 + 0.01 * dof;
      const Vector x = body.drawn(1.2, 0.9, 1), past = body.drawn(1.1, 1., 2);
      for (const CellLaw law : laws)
        for (const Tangent kind : { Tangent::exact, Tangent::convex })
        {
          const Examples examples = body.examples(parameters, law);
          const FreeDofs all(body.fe_space.n_dofs(), {}, Exchange::serial()),
              some(body.fe_space.n_dofs(), held_dofs, Exchange::serial());
          BodyPotential free(body, LawsOfCells(law), examples, all),
              held(body, LawsOfCells(law), examples, some);
          free.begin_step(s, { { 1., &past } });
          held.begin_step(s, { { 1., &past } });
          const Matrix      matrix   = assemble(free, kind, x, weights);
          Vector            expected = product(free.matrix_pattern, matrix.values, displacement);
          ElasticEvaluation at;
          held.evaluate(x, weights, at, RotationUse::update);
          ElasticEvaluation change = at;
          held.add_response(kind, displacement, x, weights, change);
          change.gradient -= at.gradient;
          change.gradient -= expected;
          EXPECT_LT(change.gradient.linfty_norm(), 1e-9 * expected.linfty_norm())
              << static_cast<int>(law) << static_cast<int>(kind);
          for (unsigned int weight = 0; weight < weights.size(); ++weight)
          {
            double of_columns = 0.;
            if (examples->is_strained(weight))
              for (const unsigned int dof : held_dofs)
                of_columns -= displacement[dof]
                              * matrix.columns[examples->strained_index(weight) * all.size() + dof];
            EXPECT_NEAR(change.weight_gradient[weight] - at.weight_gradient[weight], of_columns,
                        1e-9 * expected.linfty_norm());
          }
        }
    }

    // A resumed run does not know which points were left out when a factor was made.
    TEST_P(TangentsTest, TheConvexOneLeavesNoPointOutOfTheDamping)
    {
      const FreeDofs free_dofs(body.fe_space.n_dofs(), held_dofs, Exchange::serial());
      BodyPotential  elastic(body, ModelParameters(), none, free_dofs);
      const Vector   x = body.drawn(1.1, 0.9, 3), mirrored = body.with_mirrored_end(1.),
                   &rest = body.fe_space.rest_positions();
      elastic.begin_step(s, { { 1., &rest } });
      const Matrix convex = assemble(elastic, Tangent::convex, x, {}),
                   exact  = assemble(elastic, Tangent::exact, x, {});
      elastic.begin_step(s, { { 1., &mirrored } });
      EXPECT_EQ(assemble(elastic, Tangent::convex, x, {}).values, convex.values);
      EXPECT_NE(assemble(elastic, Tangent::exact, x, {}).values, exact.values);
    }

    // Else Newton's steps from it are too long.
    TEST_P(TangentsTest, TheConvexOneIsNowhereSofterWhereTheBodyIsStretchedFar)
    {
      const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential  elastic(body, ModelParameters(), none, free_dofs);
      const Vector   x      = body.drawn(5., 0.3, 4);
      const auto     convex = assemble(elastic, Tangent::convex, x, {}).values,
                 exact      = assemble(elastic, Tangent::exact, x, {}).values;
      const double scale    = *std::max_element(convex.begin(), convex.end());
      const auto   matrix   = make_cholesky_operator();
      matrix->reinit(elastic.matrix_pattern);
      for (std::size_t k = 0; k < convex.size(); ++k)
        matrix->values()[k] = convex[k] - exact[k];
      for (unsigned int j = 0; j < free_dofs.size(); ++j)
        matrix->values()[elastic.matrix_pattern.position(j, j)] += 1e-7 * scale;
      EXPECT_NO_THROW(matrix->factorize(x)); // it is positive definite
    }
  } // namespace
} // namespace Exemplar::Testing
