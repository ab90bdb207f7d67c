// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/weight_qp.h>
#include <exemplar/base/errors.h>
#include <exemplar/body/example_weights.h>

#include "body.h"

#include <gtest/gtest.h>

#include <numeric>

namespace Exemplar::Testing
{
  namespace
  {
    ExampleParameters
    two_poses(const WeightRule rule)
    {
      ExampleParameters parameters;
      parameters.pose_functions     = twist(60.) + " | 1.1*x; 0.9*y; z";
      parameters.importance         = 0.7;
      parameters.weights            = rule;
      parameters.prescribed_weights = rule == WeightRule::prescribed ? "1-t; t; 0" : "";
      return parameters;
    }

    TEST(ExampleWeights, KnowWhetherTheyAreUnknownAndBounded)
    {
      const Body                body;
      const Examples            simplex    = body.examples(two_poses(WeightRule::simplex));
      const Examples            free       = body.examples(two_poses(WeightRule::free));
      const Examples            prescribed = body.examples(two_poses(WeightRule::prescribed));
      const std::vector<double> some       = { 0.5, 0.2, 0.3 };
      EXPECT_EQ(simplex.weights->n_unknown(), 3u);
      EXPECT_EQ(free.weights->n_unknown(), 3u);
      EXPECT_TRUE(prescribed.weights->are_prescribed());
      EXPECT_EQ(prescribed.weights->n_unknown(), 0u);
      EXPECT_EQ(simplex.weights->limits_of_changes(some).lower,
                (std::vector<double>{ -0.5, -0.2, -0.3 }));
      EXPECT_TRUE(free.weights->limits_of_changes(some).lower.empty());
      EXPECT_EQ(simplex.weights->initial(), (std::vector<double>{ 1., 0., 0. }));
      EXPECT_EQ(prescribed.weights->at(0.25), (std::vector<double>{ 0.75, 0.25, 0. }));
      EXPECT_EQ(simplex.weights->weight_form().coupled, (std::vector<unsigned int>{ 1, 2 }));
    }

    TEST(ExampleWeights, TheBestHaveNoResidual)
    {
      const Body body;
      for (const WeightRule rule : { WeightRule::simplex, WeightRule::free })
      {
        const Examples      examples = body.examples(two_poses(rule));
        const auto         &H        = examples.weights->weight_form().H;
        std::vector<double> c        = { 0., 0.9 * H(1, 1), -0.5 * H(2, 2) };
        const auto          best     = examples.weights->best(c, { 1., 0., 0. });
        std::vector<double> gradient(3);
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            gradient[i] += H(i, j) * best[j] - (j == 0 ? c[i] : 0.);
        EXPECT_NEAR(std::accumulate(best.begin(), best.end(), 0.), 1., 1e-13);
        EXPECT_EQ(best[2] < 0., rule == WeightRule::free);
        EXPECT_LT(examples.weights->residual(best, gradient).deviation, 1e-9 * H(1, 1));
        gradient[1] += 0.1 * H(1, 1);
        EXPECT_GT(examples.weights->residual(best, gradient).deviation, 0.04 * H(1, 1));
      }
    }

    TEST(ExampleWeights, ChangesEndAtTheirBounds)
    {
      const Body          body;
      const Examples      examples = body.examples(two_poses(WeightRule::simplex));
      std::vector<double> weights  = { 0.5, 0.2, 0.3 };
      examples.weights->add({ 0.2, -0.2 - 1e-17, -1e-3 }, weights);
      EXPECT_EQ(weights[1], 0.);
      EXPECT_EQ(examples.weights->missing_sums(weights).size(), 1u);
      EXPECT_NEAR(examples.weights->missing_sums(weights)[0], 1e-3, 1e-15);
    }

    TEST(ExampleWeights, AreHeldByBoundsThatLeaveNoOther)
    {
      const Body                body;
      const Examples            examples = body.examples(two_poses(WeightRule::simplex));
      const std::vector<double> some = { 0.5, 0.2, 0.3 }, held = { 0.25, 0.75, 0. };
      examples.weights->hold(held);
      EXPECT_EQ(examples.weights->n_unknown(), 3u);
      EXPECT_EQ(examples.weights->at(0.3, some), held);
      EXPECT_EQ(examples.weights->best({ 0., 0., 1e9 }, some), held);
      const auto changes = minimize_over_weights(examples.weights->weight_form().H, { 1., 2., 1e9 },
                                                 examples.weights->missing_sums(held),
                                                 examples.weights->limits_of_changes(held));
      ASSERT_TRUE(changes.found);
      EXPECT_EQ(changes.weights, std::vector<double>(3, 0.));
      EXPECT_EQ(examples.weights->residual(held, { 1., 2., -1e9 }).deviation, 0.);
      const std::vector<std::vector<double>> all_wrong
          = { { 0.5, 0.5 }, { 0.5, 0.6, -0.1 }, { 0.5, 0.6, 0.1 } };
      for (const std::vector<double> &wrong : all_wrong)
        EXPECT_THROW(examples.weights->hold(wrong), UserError);
      EXPECT_EQ(examples.weights->at(0.3, some), held);
      examples.weights->hold({});
      EXPECT_EQ(examples.weights->at(0.3, some), some);
      EXPECT_THROW(body.examples(two_poses(WeightRule::free)).weights->hold(held), UserError);
    }

    TEST(AdditiveWeights, AreThoseOfKeysBetweenTwoBoundsWithoutASum)
    {
      const Body     body;
      const Examples examples = body.examples(two_poses(WeightRule::additive));
      const auto    &weights  = *examples.weights;
      ASSERT_EQ(weights.n_unknown(), 2u); // none of the rest pose
      EXPECT_EQ(examples.poses->number(0), 1u);
      EXPECT_EQ(weights.initial(), (std::vector<double>{ 0., 0. }));
      EXPECT_EQ(weights.weight_form().N.m(), 0u);
      EXPECT_EQ(weights.weight_form().coupled, (std::vector<unsigned int>{ 0, 1 }));
      EXPECT_TRUE(weights.missing_sums({ 0.5, 0.75 }).empty());
      const WeightLimits limits = weights.limits_of_changes({ 0.5, 0.75 });
      EXPECT_EQ(limits.lower, (std::vector<double>{ -0.5, -0.75 }));
      EXPECT_EQ(limits.upper, (std::vector<double>{ 0.5, 0.25 }));
      std::vector<double> some = { 0.1, 0.5 };
      weights.add({ 0.9 - 1e-16, -0.5 - 1e-17 }, some);
      EXPECT_EQ(some, (std::vector<double>{ 1., 0. }));
      EXPECT_TRUE(weights.is_off_bounds(0.5));
      EXPECT_FALSE(weights.is_off_bounds(0.) || weights.is_off_bounds(1.));
    }

    TEST(AdditiveWeights, HaveTheQuadraticFormOfTheSimplexWithoutTheRestPose)
    {
      const Body     body;
      const Examples simplex  = body.examples(two_poses(WeightRule::simplex));
      const Examples additive = body.examples(two_poses(WeightRule::additive));
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int j = 0; j < 2; ++j)
          EXPECT_EQ(additive.weights->weight_form().H(i, j),
                    simplex.weights->weight_form().H(i + 1, j + 1));
    }

    TEST(AdditiveWeights, TheBestHaveNoResidual)
    {
      const Body     body;
      const Examples examples = body.examples(two_poses(WeightRule::additive));
      const auto    &H        = examples.weights->weight_form().H;
      const double   unit     = H(0, 0);
      // beyond the upper bound, between both, below the lower one
      for (const double wish : { 1.5, 0.4, -0.2 })
      {
        const std::vector<double> c
            = { H(0, 0) * wish + H(0, 1) * 0.7, H(1, 0) * wish + H(1, 1) * 0.7 };
        const auto          best = examples.weights->best(c, { 0., 0. });
        std::vector<double> gradient(2);
        for (unsigned int i = 0; i < 2; ++i)
          gradient[i] = H(i, 0) * best[0] + H(i, 1) * best[1] - c[i];
        const double first = wish > 1. ? 1. : wish < 0. ? 0. : wish;
        EXPECT_NEAR(best[0], first, 1e-12);
        if (wish != 0.4)
        {
          EXPECT_EQ(best[0], first);
        }
        EXPECT_NEAR(best[1], (c[1] - H(1, 0) * first) / H(1, 1), 1e-12);
        const WeightResidual residual = examples.weights->residual(best, gradient);
        EXPECT_LT(residual.deviation, 1e-9 * unit);
        EXPECT_TRUE(residual.multipliers.empty());
        // a bound does not bear what draws away from it
        gradient[0] += (wish > 1. ? 1. : -1.) * unit;
        EXPECT_GT(examples.weights->residual(best, gradient).deviation, 0.3 * unit);
      }
    }

    TEST(AdditiveWeights, AreHeldAnywhereBetweenTheirBounds)
    {
      const Body                body;
      const Examples            examples = body.examples(two_poses(WeightRule::additive));
      const std::vector<double> held     = { 0.9, 0.75 };
      examples.weights->hold(held);
      EXPECT_EQ(examples.weights->best({ -1e9, 1e9 }, { 0., 0. }), held);
      const auto changes = minimize_over_weights(examples.weights->weight_form().H, { 1e9, -1e9 },
                                                 {}, examples.weights->limits_of_changes(held));
      EXPECT_EQ(changes.weights, std::vector<double>(2, 0.));
      for (const std::vector<double> &wrong :
           std::vector<std::vector<double>>{ { 0.5 }, { -0.1, 0.5 }, { 0.5, 1.1 } })
        EXPECT_THROW(examples.weights->hold(wrong), UserError);
    }
  } // namespace
} // namespace Exemplar::Testing
