// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/example_weights.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    // Examples of a body that is no body of cells: two numbers at each of its points, as a length and an
    // angle would be.

    constexpr double C[2][2] = { { 2., 1. }, { 1., 3. } };

    using Numbers = std::array<double, 2>;
    using Field   = std::vector<Numbers>;

    const std::vector<double> measures = { 0.5, 2., 1.5 };

    /// a:C:b
    double
    form(const Numbers &a, const Numbers &b)
    {
      double sum = 0.;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          sum += a[i] * C[i][j] * b[j];
      return sum;
    }

    /// Its integral over the points.
    double
    form(const Field &a, const Field &b)
    {
      double sum = 0.;
      for (std::size_t point = 0; point < measures.size(); ++point)
        sum += measures[point] * form(a[point], b[point]);
      return sum;
    }

    TargetForm
    form_of_points()
    {
      return { [](unsigned int, const double *a, double *T)
               {
                 for (int i = 0; i < 2; ++i)
                   T[i] = C[i][0] * a[0] + C[i][1] * a[1];
               } };
    }

    const Field first  = { { 1., 0. }, { 0.5, -2. }, { 0., 1. } },
                second = { { -1., 3. }, { 0.25, 1. }, { 2., 2. } };

    TargetBlock
    block_of(const WeightNumbers      &weights,
             const std::vector<Field> &strained,
             const RegionShares       &shares = {})
    {
      TargetBlock block({ 2, { 0, 1 } }, weights, measures, shares);
      for (unsigned int i = 0; i < strained.size(); ++i)
        for (unsigned int point = 0; point < measures.size(); ++point)
          for (unsigned int k = 0; k < 2; ++k)
            block.number(point, weights.first_strained() + i, k) = strained[i][point][k];
      return block;
    }

    ExampleTargets
    targets_of(const std::vector<std::string> &names,
               const unsigned int              first_strained,
               const RegionShares             &shares = {})
    {
      return { names, first_strained, shares, measures, Exchange::serial() };
    }

    TEST(ExampleTargets, HaveTheGramMatrixOfTheirNumbers)
    {
      ExampleTargets    targets = targets_of({ "rest", "a", "b" }, 1);
      const TargetBlock block   = block_of(targets, { first, second });
      targets.measure(block);
      targets.compute({ { block, form_of_points(), {} } });
      const Field *const fields[] = { nullptr, &first, &second };
      for (unsigned int v = 0; v < 3; ++v)
        for (unsigned int w = 0; w < 3; ++w)
          EXPECT_NEAR(targets.gram()(v, w), v * w == 0 ? 0. : form(*fields[v], *fields[w]), 1e-13);
      EXPECT_NEAR(targets.norms()[1], std::sqrt(.5 * 1. + 2. * 4.25 + 1.5 * 1.), 1e-14);
      EXPECT_EQ(targets.norms()[0], 0.);
      EXPECT_FALSE(targets.is_strained(0));
      EXPECT_EQ(targets.strained_index(2), 1u);
    }

    TEST(ExampleTargets, BlendByWeights)
    {
      const TargetBlock block  = block_of({ 3, 1 }, { first, second });
      double            sum[2] = { 10., 20. };
      block.add_blend(1, { .5, .2, .3 }, sum);
      for (int k = 0; k < 2; ++k)
        EXPECT_NEAR(sum[k], 10. * (k + 1) + .2 * first[1][k] + .3 * second[1][k], 1e-14);
    }

    TEST(ExampleTargets, AreSharedOutToRegions)
    {
      // the middle point belongs to both regions
      const RegionShares shares({ 7, 9 }, { 0, 1, 3, 4 },
                                { { 0, 1. }, { 0, .25 }, { 1, .75 }, { 1, 1. } });
      ExampleTargets     targets = targets_of({ "a" }, 0, shares);
      const TargetBlock  block   = block_of(targets, { first }, shares);
      targets.compute({ { block, form_of_points(), {} } });
      EXPECT_EQ(targets.n_weights(), 2u);
      EXPECT_EQ(targets.region_id(1), 9u);
      EXPECT_NEAR(targets.fractions()[0], (.5 + .25 * 2.) / 4., 1e-15);
      EXPECT_NEAR(targets.measures_of_weights()[1], .75 * 2. + 1.5, 1e-15);
      EXPECT_NEAR(targets.gram()(0, 1), .25 * .75 * 2. * form(first[1], first[1]), 1e-14);
      EXPECT_NEAR(targets.gram()(1, 1),
                  .75 * .75 * 2. * form(first[1], first[1]) + 1.5 * form(first[2], first[2]),
                  1e-14);
    }

    TEST(ExampleTargets, SumOverBlocksOfDifferentKinds)
    {
      // a second kind of points: one number, a list for each weight
      ExampleTargets    targets = targets_of({ "a", "b" }, 0);
      const TargetBlock block   = block_of(targets, { first, second });
      TargetBlock       means({ 1, { 0 } }, WeightNumbers(2), { 3. });
      means.number(0, 0, 0) = 2.;
      means.number(0, 1, 0) = -1.;
      const auto stiffness  = [](const double of)
      { return TargetForm{ [of](unsigned int, const double *a, double *T) { *T = of * *a; } }; };
      targets.set_importance(.8);
      targets.compute({ { block, form_of_points(), {} }, { means, stiffness(5.), {} } });
      EXPECT_NEAR(targets.gram()(0, 1), form(first, second) - 3. * 5. * 2., 1e-13);
      // without an excess the blended form is a multiple of the Gram matrix
      dealii::FullMatrix<double> sum(2, 2);
      targets.add_blended(2., sum);
      EXPECT_NEAR(sum(0, 1), 2. * .2 / .8 * targets.gram()(0, 1), 1e-13);
      targets.compute(
          { { block, form_of_points(), { form_of_points().dual, [](unsigned int) { return .5; } } },
            { means, stiffness(5.), stiffness(1.) } });
      sum = 0.;
      targets.add_blended(2., sum);
      EXPECT_NEAR(sum(0, 1), 2. * (.5 * form(first, second) - 3. * 2.), 1e-13);
    }

    TEST(ExampleTargets, CountNumbersAsOftenAsTheirSpaceSays)
    {
      const TargetSpace symmetric{ 3, { 0, 2, 2, 1 } }; // xx, yy, xy
      const double      a[] = { 1., 2., 3. }, b[] = { 4., 5., 6. };
      EXPECT_EQ(symmetric.product(a, b), 4. + 10. + 2. * 18.);
    }

    TEST(ExampleTargets, AreRoundedToSinglePrecisionTogether)
    {
      TargetBlock block({ 1, { 0 } }, WeightNumbers(1), { 1. });
      block.number(0, 0, 0) = 1. / 3.;
      EXPECT_EQ(block.arrays().in_single, nullptr);
      block.round_to_single();
      EXPECT_EQ(block.number(0, 0, 0), double(1.f / 3.f));
      EXPECT_EQ(block.arrays().in_single[0], 1.f / 3.f);
    }

    /// The state (1 - x) first + x second + y normal, where the latter is of no example.
    Field
    state_at(const double x)
    {
      Field state = first;
      for (std::size_t point = 0; point < measures.size(); ++point)
        for (int k = 0; k < 2; ++k)
          state[point][k] = (1. - x) * first[point][k] + x * second[point][k] + .3 * k;
      return state;
    }

    TEST(ExampleTargets, WeightsOfTwoAreFoundByProjection)
    {
      ExampleTargets    targets = targets_of({ "a", "b" }, 0);
      const TargetBlock block   = block_of(targets, { first, second });
      targets.set_importance(1.);
      targets.measure(block);
      targets.compute({ { block, form_of_points(), {} } });
      for (const WeightRule rule : { WeightRule::free, WeightRule::simplex })
        for (const double x : { -.8, .3, .9, 1.7 })
        {
          ExampleParameters parameters;
          parameters.energy         = ExampleEnergy::scaled;
          parameters.weight_penalty = "0";
          parameters.weights        = rule;
          const ExampleWeights weights(parameters, targets, 1.,
                                       TimeAxis::of_increments(TimeParameters()));
          const Field          state = state_at(x);
          // the nearest to the state on the line through both
          Field along = second, from = state;
          for (std::size_t point = 0; point < measures.size(); ++point)
            for (int k = 0; k < 2; ++k)
            {
              along[point][k] -= first[point][k];
              from[point][k] -= first[point][k];
            }
          double expected = form(from, along) / form(along, along);
          if (rule == WeightRule::simplex)
            expected = std::min(std::max(expected, 0.), 1.);
          const auto found = weights.best({ form(first, state), form(second, state) }, { 1., 0. });
          EXPECT_NEAR(found[1], expected, 1e-13) << x;
          EXPECT_NEAR(found[0], 1. - expected, 1e-13) << x;
        }
    }
  } // namespace
} // namespace Exemplar::Testing
