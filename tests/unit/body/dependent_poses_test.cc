// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/body/dependent_poses.h>
#include <exemplar/body/example_weights.h>

#include "body.h"
#include "expect_contains.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    /// The bar of 4 by 1 by 1 m bent to an arc by an angle [rad], its middle line as long as before.
    std::string
    arc(const std::string &angle)
    {
      const std::string r = "(4/(" + angle + "))";
      return "(" + r + "-z)*sin(x/" + r + "); y; " + r + "-(" + r + "-z)*cos(x/" + r + ")";
    }

    ExampleParameters
    examples_of(const std::string &poses, const WeightRule rule = WeightRule::simplex)
    {
      ExampleParameters parameters;
      parameters.pose_functions = poses;
      parameters.weights        = rule;
      return parameters;
    }

    /// Linear terms c of the weights' quadratic for the strains sum v_i E_i of the examples and no penalty.
    std::vector<double>
    linear_terms(const Examples &examples, const std::vector<double> &v)
    {
      const auto         &G = examples.poses->gram();
      std::vector<double> c(G.m(), 0.);
      for (unsigned int i = 0; i < G.m(); ++i)
        for (unsigned int j = 0; j < G.m(); ++j)
          c[i] += G(i, j) * v[j];
      return c;
    }

    double
    energy_norm(const Examples &examples, const std::vector<double> &v)
    {
      const std::vector<double> c   = linear_terms(examples, v);
      double                    sum = 0.;
      for (std::size_t i = 0; i < v.size(); ++i)
        sum += c[i] * v[i];
      return std::sqrt(sum);
    }

    /// The scaled energy without its blended part, whose weights are those of the strains themselves.
    ExampleParameters
    scaled(ExampleParameters parameters)
    {
      parameters.energy = ExampleEnergy::scaled;
      return parameters;
    }

    void
    expect_weights(const std::vector<double> &found,
                   const std::vector<double> &expected,
                   const double               delta)
    {
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], delta) << i;
    }

    const std::string up_and_down = arc("0.3") + " | " + arc("-0.3");

    TEST(DependentPoses, OppositePosesAreFoundWithTheSizeOfTheirSum)
    {
      const Body body;
      const auto examples = body.examples(examples_of(up_and_down));
      const auto found    = find_dependent_poses(*examples.poses, true);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_EQ(found[0].weights, (std::vector<unsigned int>{ 1, 2 }));
      EXPECT_TRUE(found[0].involves_rest);
      const double one   = energy_norm(examples, { 0., 1., 0. }),
                   other = energy_norm(examples, { 0., 0., 1. });
      EXPECT_NEAR(found[0].remainder,
                  energy_norm(examples, { 0., 1., one / other }) / (std::sqrt(2.) * one), 1e-5);
      ASSERT_EQ(examples.weights->get_warnings().size(), 1u);
      const std::string warning = examples.weights->get_warnings()[0];
      expect_contains(warning, "1 (pose function '" + arc("0.3") + "') and 2 (pose function '");
      expect_contains(warning, "prefers the rest pose; positions change by up to some "
                                   + short_text(100. * found[0].remainder) + " %");
    }

    TEST(DependentPoses, IndependentFreeAndPrescribedWeightsAreLeftAlone)
    {
      const Body body;
      EXPECT_TRUE(body.examples(examples_of(twist(60.) + " | 1.1*x; 0.9*y; z"))
                      .weights->preferences()
                      .empty());
      EXPECT_TRUE(
          body.examples(examples_of(up_and_down, WeightRule::free)).weights->preferences().empty());
      ExampleParameters prescribed  = examples_of(up_and_down, WeightRule::prescribed);
      prescribed.prescribed_weights = "1; 0; 0";
      EXPECT_TRUE(body.examples(prescribed).weights->preferences().empty());
    }

    TEST(DependentPoses, StatesBetweenRestAndOnePoseHaveItsWeightAlone)
    {
      const Body body;
      for (const WeightRule rule : { WeightRule::simplex, WeightRule::additive })
      {
        const auto examples  = body.examples(scaled(examples_of(up_and_down, rule)));
        const bool has_rest  = rule == WeightRule::simplex;
        const auto with_rest = [&](const double up, const double down)
        {
          return has_rest ? std::vector<double>{ 1. - up - down, up, down }
                          : std::vector<double>{ up, down };
        };
        for (const double w : { .1, .5, 1. })
        {
          // as exactly as without the penalty
          expect_weights(examples.weights->best(linear_terms(examples, with_rest(w, 0.)),
                                                examples.weights->initial()),
                         with_rest(w, 0.), 1e-5);
          expect_weights(examples.weights->best(linear_terms(examples, with_rest(0., w)),
                                                examples.weights->initial()),
                         with_rest(0., w), 1e-5);
        }
        // both by one half have hardly any strain
        expect_weights(examples.weights->best(linear_terms(examples, with_rest(.5, .5)),
                                              examples.weights->initial()),
                       with_rest(0., 0.), 0.04);
      }
    }

    TEST(DependentPoses, WeightsChangeByThreeTimesThoseOfOnePoseAtMost)
    {
      const Body                             body;
      std::mt19937                           generator(1);
      std::uniform_real_distribution<double> any(0., 1.);
      for (const std::string &poses :
           { up_and_down, arc("0.05") + " | " + arc("-0.6"), arc("0.3") + " | " + arc("0.6"),
             arc("0.3") + " | " + twist(40.) + " | " + arc("-0.2"),
             arc("0.5") + " | " + arc("0.501") })
      {
        const auto examples = body.examples(scaled(examples_of(poses)));
        const auto n        = examples.weights->size();
        double     least    = 1e300; // norm of a pose
        for (unsigned int i = 1; i < n; ++i)
        {
          std::vector<double> one(n, 0.);
          one[i] = 1.;
          least  = std::min(least, energy_norm(examples, one));
        }
        ASSERT_FALSE(examples.weights->preferences().empty()) << poses;
        // the strain that moves weights most is that of the small combination itself
        const auto          found = find_dependent_poses(*examples.poses, true);
        std::vector<double> along(n, 0.);
        for (std::size_t k = 0; k < found[0].weights.size(); ++k)
          along[found[0].weights[k]]
              = found[0].combination[k]
                / std::sqrt(examples.poses->gram()(found[0].weights[k], found[0].weights[k]));
        double worst = 0.;
        for (unsigned int trial = 0; trial < 200; ++trial)
        {
          std::vector<double> v(n, 0.), other(n);
          for (unsigned int i = 1; i < n; ++i)
            v[i] = any(generator);
          for (unsigned int i = 0; i < n; ++i)
            other[i] = v[i] + 1e-3 * along[i];
          const auto a
              = examples.weights->best(linear_terms(examples, v), examples.weights->initial()),
              b
              = examples.weights->best(linear_terms(examples, other), examples.weights->initial());
          double change = 0.;
          for (unsigned int i = 1; i < n; ++i)
            change += std::pow(b[i] - a[i], 2);
          const double strain = 1e-3 * energy_norm(examples, along);
          worst               = std::max(worst, std::sqrt(change) * least / strain);
        }
        EXPECT_LT(worst, 3.) << poses;
      }
    }

    TEST(DependentPoses, OfAPoseBetweenTwoOthersItIsPreferred)
    {
      // cubes stretched along x, along z, and by half of each
      const Body body;
      const auto examples
          = body.examples(scaled(examples_of("1.2*x; y; z | x; y; 1.2*z | 1.1*x; y; 1.1*z")));
      const auto found = find_dependent_poses(*examples.poses, true);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_FALSE(found[0].involves_rest);
      EXPECT_LT(found[0].remainder, 1e-7);
      const auto best = [&](const std::vector<double> &v) {
        return examples.weights->best(linear_terms(examples, v), { 1., 0., 0., 0. });
      };
      expect_weights(best({ 0., .5, .5, 0. }), { 0., 0., 0., 1. }, 1e-5);
      expect_weights(best({ .2, .5, .3, 0. }), { .2, .2, 0., .6 }, 1e-5);
      expect_weights(best({ .5, .5, 0., 0. }), { .5, .5, 0., 0. }, 1e-5);
      expect_contains(examples.weights->get_warnings().back(),
                      "prefers the poses between the others");
    }

    TEST(DependentPoses, EqualPosesShareTheirWeight)
    {
      const Body        body;
      ExampleParameters parameters
          = scaled(examples_of(twist(60.) + " | 1.2*x; y; z | 1.2*x; y; z"));
      for (const bool rest : { true, false })
      {
        parameters.include_rest_pose = rest;
        const auto          examples = body.examples(parameters);
        std::vector<double> v{ .4, .6, 0. }, expected{ .4, .3, .3 };
        if (rest)
        {
          v.insert(v.begin(), 0.);
          expected.insert(expected.begin(), 0.);
        }
        expect_weights(
            examples.weights->best(linear_terms(examples, v), examples.weights->initial()),
            expected, 1e-5);
        expect_contains(examples.weights->get_warnings().back(), "prefers equal weights");
      }
    }

    TEST(DependentPoses, APoseOnTheWayToAnotherGivesItsWeightToRest)
    {
      const Body body;
      const auto examples = body.examples(scaled(examples_of("1.1*x; y; z | 1.2*x; y; z")));
      const auto best
          = examples.weights->best(linear_terms(examples, { 0., .8, 0. }), { 1., 0., 0. });
      expect_weights(best, { .6, 0., .4 }, 1e-5);
    }

    TEST(DependentPoses, TwoPairsOfOppositePosesAreFoundApart)
    {
      const Body body;
      const auto examples = body.examples(
          examples_of(arc("0.3") + " | " + twist(3.) + " | " + arc("-0.3") + " | " + twist(-3.)));
      const auto found = find_dependent_poses(*examples.poses, true);
      ASSERT_EQ(found.size(), 2u);
      const bool first_is_arc = found[0].weights[0] == 1;
      EXPECT_EQ(found[first_is_arc ? 0 : 1].weights, (std::vector<unsigned int>{ 1, 3 }));
      EXPECT_EQ(found[first_is_arc ? 1 : 0].weights, (std::vector<unsigned int>{ 2, 4 }));
    }

    TEST(DependentPoses, SmallChangesOfPosesAndMaterialDoNotChangeThePenalty)
    {
      const Body body;
      const auto examples = body.examples(examples_of(up_and_down)),
                 other    = body.examples(examples_of(arc("0.3001") + " | " + arc("-0.2999")));
      ASSERT_FALSE(examples.weights->preferences().empty());
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          EXPECT_EQ(examples.weights->preferences()(i, j), other.weights->preferences()(i, j));
    }
  } // namespace
} // namespace Exemplar::Testing
