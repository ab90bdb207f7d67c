// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/line_search.h>

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    Merit
    merit(const double potential, const double max_free_gradient)
    {
      Merit at;
      at.potential         = potential;
      at.max_free_gradient = max_free_gradient;
      return at;
    }

    TEST(LineSearch, ADescentIsAPartOfWhatTheSlopePromises)
    {
      const Merit before = merit(3., 1.);
      EXPECT_TRUE(is_better(merit(3. - 2e-4, 9.), before, -1.));
      EXPECT_FALSE(is_better(merit(3. - 0.5e-4, 0.1), before, -1.));
      EXPECT_FALSE(is_better(merit(3., 0.1), before, -1.));
      EXPECT_FALSE(is_better(merit(3.1, 0.1), before, -1.));
    }

    TEST(LineSearch, BelowRoundingTheGradientTells)
    {
      const Merit before = merit(-1e6, 1.);
      EXPECT_TRUE(is_below_rounding(before, -1e-4));
      EXPECT_FALSE(is_below_rounding(before, -1e-2));
      EXPECT_TRUE(is_better(merit(-1e6, 0.9), before, -1e-4));
      EXPECT_FALSE(is_better(merit(-1e6, 1.1), before, -1e-4));
      // a fall of the gradient is no excuse for a rise that is more than rounding
      EXPECT_FALSE(is_better(merit(-1e6 + 0.1, 0.9), before, -1e-4));
    }

    TEST(LineSearch, OffASaddleTheSlopesTellWhatThePotentialCannot)
    {
      // f = 1e6 - x^2 / 2 from x = 1e-6, where the slope is -1e-6 and every fall is below rounding
      const auto  at     = [](const double x) { return merit(1e6 - x * x / 2., std::abs(x)); };
      const Merit before = at(1e-6), now = at(3e-6);
      EXPECT_TRUE(is_below_rounding(before, -2e-12));
      EXPECT_FALSE(is_better(now, before, -2e-12)); // the gradient has grown
      EXPECT_TRUE(is_better_by_slopes(now, before, -1e-6, -3e-6, 2e-6));
      EXPECT_TRUE(is_better_by_slopes(now, before, -1e-6, 0.9e-6, 2e-6));  // beyond a minimum,
      EXPECT_FALSE(is_better_by_slopes(now, before, -1e-6, 1.1e-6, 2e-6)); // and too far
      EXPECT_FALSE(is_better_by_slopes(now, before, -1e-6, -3e-6, 1e6)); // large enough to be seen
    }
  } // namespace
} // namespace Exemplar::Testing
