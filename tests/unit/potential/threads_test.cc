// SPDX-License-Identifier: GPL-3.0-or-later
#include "body.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// All that loops over the cells and patches of a body make, with so many threads.
    struct Made
    {
      Made(const Body                      &body,
           const Examples                  &examples,
           const std::vector<unsigned int> &held,
           const Tangent                    kind,
           const double                     length,
           const unsigned int               n_threads)
      {
        const FreeDofs         free_dofs(body.fe_space.n_dofs(), held, Exchange::serial());
        const SymmetricPattern pattern = make_pattern(body.fe_space, couplings_of(body), free_dofs);
        ElasticPotential       potential({ CellLaw::corotational, body.fe_space, body.material,
                                           body.cell_material, body.patches, *examples.poses,
                                           *examples.weights, free_dofs, n_threads });
        potential.attach(pattern);
        const Vector              x       = body.drawn(length, 1. / std::sqrt(length), 7);
        const std::vector<double> weights = { 0.1, 0.3, 0.6 };
        potential.evaluate(x, weights, evaluation, RotationUse::update);
        linear_term = potential.weight_linear_term(x, RotationUse::update);
        values.resize(pattern.n_values());
        potential.assemble_tangent(kind, x, weights, values, columns);
        potential.get_field().node_rotations(rotations);
      }

      ElasticEvaluation   evaluation;
      std::vector<double> linear_term, values, columns;
      std::vector<float>  rotations;
    };

    class ThreadsTest : public testing::TestWithParam<std::tuple<bool, Tangent, double>>
    {
    };

    // the last ones are strongly stretched
    INSTANTIATE_TEST_SUITE_P(,
                             ThreadsTest,
                             testing::Combine(testing::Bool(),
                                              testing::Values(Tangent::exact, Tangent::convex),
                                              testing::Values(1.2, 4.)));

    TEST_P(ThreadsTest, NoNumberDependsOnHowManyThereAre)
    {
      const auto [has_patches, kind, length] = GetParam();
      Body body(box_mesh(4., 42, 7)); // three stripes
      ASSERT_GT(body.fe_space.n_cells(), 12000u);
      if (has_patches)
        body.make_patches();
      ExampleParameters parameters;
      parameters.pose_functions                = twist(60.) + " | 1.1*x; 0.9*y; z";
      parameters.importance                    = 0.7;
      const Examples                  examples = body.examples(parameters);
      const std::vector<unsigned int> held     = { 0, 1, 2, 300, 302, 700, 1203, 1204 };
      const Made                      one(body, examples, held, kind, length, 1);
      for (const unsigned int n : { 2, 5 })
      {
        const Made several(body, examples, held, kind, length, n);
        EXPECT_EQ(several.evaluation.energy, one.evaluation.energy);
        EXPECT_EQ(several.evaluation.gradient, one.evaluation.gradient);
        EXPECT_EQ(several.evaluation.force_scale, one.evaluation.force_scale);
        EXPECT_EQ(several.evaluation.weight_gradient, one.evaluation.weight_gradient);
        EXPECT_EQ(several.linear_term, one.linear_term);
        EXPECT_EQ(several.values, one.values);
        EXPECT_EQ(several.columns, one.columns);
        EXPECT_EQ(several.rotations, one.rotations);
      }
    }

    TEST(NodalSums, PlacesOfANodeAreTogetherWhatItsCellsAdd)
    {
      const Body       body(box_mesh(4., 42, 7));
      const CellLaw    law = CellLaw::corotational;
      CellBatches      batches(body.fe_space, body.material, law, ExampleConstants());
      const CellArrays cells = batches.arrays();
      NodalSums        sums(cells, 4, body.fe_space.n_nodes(), 2);
      ASSERT_GT(sums.n_stripes(), 1u);
      ASSERT_GT(sums.n_places(), body.fe_space.n_nodes());
      sums.for_each_stripe(
          [&](std::size_t, const std::size_t begin, const std::size_t end, double *to)
          {
            for (std::size_t i = 4 * batch_size * begin; i < 4 * batch_size * end; ++i)
              to[4 * sums.get_places()[i]] += 1.;
          });
      Vector n_cells(body.fe_space.n_dofs()), scales(body.fe_space.n_nodes());
      sums.copy_to(n_cells, scales);
      std::vector<double> expected(body.fe_space.n_nodes(), 0.);
      for (std::size_t i = 0; i < 4 * batch_size * cells.n_batches(); ++i)
        expected[cells.nodes[i]] += 1.;
      for (unsigned int node = 0; node < expected.size(); ++node)
        EXPECT_EQ(n_cells[3 * node], expected[node]);
    }
  } // namespace
} // namespace Exemplar::Testing
