// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/nearest_word.h>

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(NearestWord, CountsChanges)
    {
      EXPECT_EQ(edit_distance("", "abc"), 3U);
      EXPECT_EQ(edit_distance("output", "output"), 0U);
      EXPECT_EQ(edit_distance("Output", "oUTPUT"), 0U);
      EXPECT_EQ(edit_distance("ouput", "output"), 1U);
      EXPECT_EQ(edit_distance("outptu", "output"), 1U); // exchanged neighbours
      EXPECT_EQ(edit_distance("left", "right"), 4U);
      EXPECT_EQ(edit_distance(std::string(1000, 'x'), "x"), 1000U);
    }

    TEST(NearestWord, IsNoneIfAllAreFar)
    {
      EXPECT_EQ(nearest_word("--outptu", { "--quiet", "--output" }), "--output");
      EXPECT_EQ(nearest_word("--importance", { "--quiet", "--output" }), "");
      EXPECT_EQ(nearest_word("a", {}), "");
    }

    TEST(NearestWord, HasTheSameCapitals)
    {
      EXPECT_EQ(nearest_word("Bar.msh", { "BAR.MSH", "bar.msh" }), "bar.msh");
      EXPECT_EQ(nearest_word("BAR.Msh", { "bar.msh", "BAR.MSH" }), "BAR.MSH");
    }
  } // namespace
} // namespace Exemplar::Testing
