// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/degrees.h>

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(Degrees, AreWholeFifteensWithoutPi)
    {
      const auto found = find_degrees("x*cos(90*t) - tan ((1+t)*45); 0; sin(sin(360*min(t,1)))");
      ASSERT_EQ(found.size(), 4U);
      EXPECT_EQ(found[0].function + "(" + found[0].argument + ")", "cos(90*t)");
      EXPECT_EQ(found[1].argument, "(1+t)*45");
      EXPECT_EQ(found[1].number, "45");
      EXPECT_EQ(found[2].argument, "sin(360*min(t,1))");
      EXPECT_EQ(found[3].argument, "360*min(t,1)");
      EXPECT_FALSE(found[0].lacks_pi);
      EXPECT_TRUE(find_degrees("sin(90/180*t)").at(0).lacks_pi);
      EXPECT_FALSE(find_degrees("sin(90/1800*t)").at(0).lacks_pi);
    }

    TEST(Degrees, OtherNumbersAreNone)
    {
      for (const char *formula :
           { "sin(90*pi/180*t)", "sin(8*t)", "cos(t/90)", "sin(31*t)", "sin(90.5*t)", "asin(90*t)",
             "90*sin(t)", "sin(x90)", "sin(1.90*t)", "sin(90*t", "sin(15*t)", "exp(90*t)", "" })
        EXPECT_TRUE(find_degrees(formula).empty()) << formula;
    }
  } // namespace
} // namespace Exemplar::Testing
