// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/example_sums.h>

#include "body.h"
#include "expect_contains.h"

#include <gtest/gtest.h>
#include <algorithm>

#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    std::vector<std::string>
    warnings_of(const std::string &poses)
    {
      ExampleParameters parameters;
      parameters.pose_functions = poses;
      parameters.weights        = WeightRule::additive;
      const Body     body;
      const Examples examples = body.examples(parameters);
      auto           all      = examples.poses->get_warnings();
      const auto    &further  = examples.weights->get_warnings();
      all.insert(all.end(), further.begin(), further.end());
      return all;
    }

    TEST(SumsOfStrains, TheLeastIsThatOfAllCorners)
    {
      std::mt19937                     generator(3);
      std::normal_distribution<double> normal(0., 0.2);
      unsigned int                     n_of_several = 0, n_least = 0;
      for (int sample = 0; sample < 200; ++sample)
      {
        std::vector<Matrix3<double>> strains(5);
        for (Matrix3<double> &E : strains)
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j <= i; ++j)
              E[i][j] = E[j][i] = normal(generator);
        double least = 0.;
        for (unsigned int corner = 0; corner < 32; ++corner)
        {
          Matrix3<double> sum{};
          for (unsigned int i = 0; i < 5; ++i)
            if ((corner >> i & 1u) != 0)
              sum = combine(1., sum, 1., strains[i]);
          const Eigensystem<double> all = symmetric_eigensystem(sum);
          for (const int e : { 0, 1, 2 })
            least = std::min(least, all.values[e]);
        }
        const AddedStrain found = least_sum_of_strains(strains);
        EXPECT_GE(found.least, least - 1e-12);
        EXPECT_LT(found.least, 0.9 * least);
        n_least += found.least < least + 1e-12 ? 1 : 0;
        n_of_several += found.parts.size() > 1 ? 1 : 0;
      }
      EXPECT_GT(n_of_several, 150u);
      EXPECT_GT(n_least, 180u); // the others are local minima
    }

    TEST(SumsOfStrains, KeysThatWantNoThicknessAreNamedWithTheirPlace)
    {
      // in the first of four cubes alone, of 1.2 of its length
      const std::string a = "x<1 ? 0.6*x : x-0.4; y; z", b = "x<1 ? 0.6*x : x-0.4; y; z+0.001*x";
      const std::string far    = "x<3 ? x : 3+0.5*(x-3); y; z";
      const auto        of_two = warnings_of(a + " | " + b + " | " + far); // nearly equal keys
      ASSERT_EQ(of_two.size(), 1u);
      EXPECT_EQ(of_two[0].find("stretch of 0 or less"), std::string::npos);
      auto all = warnings_of(a + " | " + far + " | " + b + " | x<1 ? 0.6*x : x-0.4; y+0.001*x; z");
      all.erase(std::remove_if(all.begin(), all.end(),
                               [](const std::string &warning) {
                                 return warning.find("a combination of their") != std::string::npos;
                               }),
                all.end());
      ASSERT_EQ(all.size(), 1u);
      expect_contains(all[0], "stretch of 0 or less");
      expect_contains(
          all[0], "They do in 6 cells, element 37, 38, 39, 40, 41 and 1 more; most in element 37");
      expect_contains(all[0],
                      "keys 1 (pose function '" + a + "'), 3 (pose function '" + b + "'), 4 (");
      expect_contains(all[0], "want a strain of -1.2");
      expect_contains(all[0], "Examples/Weights = simplex");
    }

    TEST(SumsOfStrains, KeysThatAreSumsOfOthersAreNamed)
    {
      const auto all = warnings_of("1.1*x; y; z | 1.3*x; y; z");
      ASSERT_EQ(all.size(), 1u);
      expect_contains(all[0], "Examples 1 (pose function '1.1*x; y; z') and 2 (pose function "
                              "'1.3*x; y; z'): a combination of their strains is less than");
    }
  } // namespace
} // namespace Exemplar::Testing
