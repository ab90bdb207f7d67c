// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace Exemplar::Testing
{
  TEST(LongVectors, GreatestMagnitudeOfNumbersInfinityAndNaN)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double nan      = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(max_entry({}), 0.);
    EXPECT_EQ(max_entry({ -0., 0. }), 0.);
    EXPECT_EQ(max_entry({ 1., -3.5, 2. }), 3.5);
    EXPECT_EQ(max_entry({ 5e-324, -1e-320, 0. }), 1e-320);
    EXPECT_EQ(max_entry({ 1e308, -infinity, 1. }), infinity);
    for (const double not_a_number : { nan, -nan })
    {
      EXPECT_TRUE(std::isnan(max_entry({ not_a_number, 1., -infinity })));
      EXPECT_TRUE(std::isnan(max_entry({ -infinity, not_a_number, 1. })));
      EXPECT_TRUE(std::isnan(max_entry({ 1., -infinity, not_a_number })));
    }
  }

  TEST(LongVectors, TheGreaterOfTwoKeepsANaN)
  {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(max_or_nan(1., 2.), 2.);
    EXPECT_EQ(max_or_nan(2., 1.), 2.);
    EXPECT_EQ(min_or_nan(1., 2.), 1.);
    EXPECT_EQ(min_or_nan(2., 1.), 1.);
    for (const auto &[a, b] : { std::pair(nan, 1.), std::pair(1., nan), std::pair(nan, nan) })
    {
      EXPECT_TRUE(std::isnan(max_or_nan(a, b)));
      EXPECT_TRUE(std::isnan(min_or_nan(a, b)));
    }
  }
} // namespace Exemplar::Testing
