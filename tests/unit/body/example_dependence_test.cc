// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>

#include "body.h"
#include "expect_contains.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    std::vector<std::string>
    warnings(const std::string &poses, const WeightRule rule = WeightRule::simplex)
    {
      ExampleParameters parameters;
      parameters.pose_functions = poses;
      parameters.weights        = rule;
      return Body().examples(parameters).get_warnings();
    }

    TEST(ExampleDependence, IndependentExamplesGiveNoWarning)
    {
      EXPECT_TRUE(warnings(twist(60.)).empty());
      EXPECT_TRUE(warnings(twist(60.) + " | 1.1*x; y; z | x; y; 1.1*z").empty());
    }

    TEST(ExampleDependence, DuplicatesAndCombinationsAreNamed)
    {
      const std::string stretch = "1.1*x; y; z | ";
      for (const std::string last : { "1.1*x; y; z", "1.3*x; y; z", "x; y; z" })
      {
        const auto all     = warnings(twist(30.) + " | " + stretch + last, WeightRule::free);
        const bool is_rest = last == "x; y; z"; // which is said first
        ASSERT_EQ(all.size(), is_rest ? 2u : 1u) << last;
        if (is_rest)
          expect_contains(all[0], "(pose function 'x; y; z') is the rest pose, moved rigidly");
        expect_contains(all.back(),
                        "Example 3 (pose function '" + last + "') is an affine combination");
      }
    }

    TEST(ExampleDependence, WithoutARidgeNoEnergyDecidesBetweenThem)
    {
      ExampleParameters parameters;
      parameters.pose_functions = "1.1*x; y; z | 1.3*x; y; z";
      parameters.weight_penalty = "0";
      for (const ExampleEnergy energy :
           { ExampleEnergy::scaled, ExampleEnergy::blended, ExampleEnergy::mixed })
      {
        parameters.energy = energy;
        EXPECT_THROW(Body().examples(parameters), UserError);
      }
    }

    TEST(ExampleDependence, NearlyEqualExamplesGiveTheConditionNumber)
    {
      // strains 0.1 e_xx and 0.1 e_xx + d e_zz: to first order in d the scaled Gram matrix
      // [1, c; c, 1] has the condition number (1 + c)/(1 - c)
      const auto all = warnings("1.1*x; y; z | 1.1*x; y; 1.000001*z", WeightRule::free);
      ASSERT_EQ(all.size(), 1u);
      EXPECT_NE(all[0].find("nearly an affine combination"), std::string::npos) << all[0];
      const double number = std::stod(all[0].substr(all[0].find("condition number ") + 17));
      // nu = .45: C in units of mu: lambda = 9 mu; |e_xx|^2 = 11, e_xx:C:e_zz = 9
      const double d = 1e-5, n = 11., m = 9.; // d relative to 0.1
      const double sine_squared = d * d * (n * n - m * m) / (n * n);
      EXPECT_NEAR(number / (4. / sine_squared), 1., 1e-3);
    }
  } // namespace
} // namespace Exemplar::Testing
