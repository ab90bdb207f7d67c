// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>

#include <gtest/gtest.h>

namespace Exemplar
{
  namespace
  {
    TEST(NumberText, IsOfDecimalDigitsAlone)
    {
      EXPECT_EQ(decimal_number<unsigned int>("0"), 0u);
      EXPECT_EQ(decimal_number<unsigned int>("010"), 10u); // not octal
      EXPECT_EQ(decimal_number<unsigned int>("4294967295"), 4294967295u);
      EXPECT_EQ(decimal_number<double>("30"), 30.);
      EXPECT_EQ(decimal_number<double>("-.5e-3"), -.5e-3);
      EXPECT_EQ(decimal_number<double>("1e308"), 1e308);
      EXPECT_TRUE(std::signbit(*decimal_number<double>("-0")));
      for (const std::string text : { "",       " ",           "-",      "+5",
                                      " 5",     "5 ",          "5\n",    "5x",
                                      "5 5",    "5;",          "5,0",    "1_0",
                                      "1'000",  "--5",         "0x10",   "0X10",
                                      "0x1p3",  "1e",          "1e+",    ".",
                                      "e5",     "nan",         "NaN",    "-nan",
                                      "nan(1)", "inf",         "-inf",   "infinity",
                                      "1e400",  "-1e400",      "1e-400", "1e99999999999999999999",
                                      "true",   "\xef\xbc\x99" })
      {
        EXPECT_EQ(decimal_number<double>(text), std::nullopt) << text;
        EXPECT_EQ(decimal_number<unsigned int>(text), std::nullopt) << text;
      }
      EXPECT_EQ(decimal_number<double>(std::string_view("5\0", 2)), std::nullopt);
      for (const std::string text : { "-0", "-1", "1.5", "1.0", "1e1", "4294967296", "4294967301",
                                      "18446744073709551621", "99999999999999999999999999" })
        EXPECT_EQ(decimal_number<unsigned int>(text), std::nullopt) << text;
    }
  } // namespace
} // namespace Exemplar
