// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(MessageText, TextIsUtf8WithoutControlCharacters)
    {
      for (const std::string good : { "", "a b\tc", "\u00e4\u20ac\U0001f600\U0010ffff" })
        EXPECT_EQ(find_unprintable(good), std::string::npos) << good;
      // a lonely byte, halves, too long forms, surrogates, beyond Unicode, C0 and C1 controls
      for (const std::string bad :
           { "\xe4", "\xc3", "\xe2\x82", "\x80", "\xc0\x80", "\xe0\x80\x80", "\xf0\x80\x80\x80",
             "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80", "\xff", "\x1b", "\n",
             "\x7f", "\xc2\x85" })
        EXPECT_EQ(find_unprintable("ab" + bad + "c"), 2u) << printable(bad);
      EXPECT_EQ(find_unprintable(std::string("a\0", 2)), 1u);
    }

    TEST(MessageText, OtherBytesAreShownByTheirNumbers)
    {
      EXPECT_EQ(printable("\u00e4\xe4\x1b[2J\n"), "\u00e4\\xe4\\x1b[2J\\x0a");
      EXPECT_EQ(printable(std::string("\0", 1)), "\\x00");
      EXPECT_EQ(find_unprintable(printable("\xe2\x82\n\xff")), std::string::npos);
      EXPECT_EQ(in_quotes("word"), "'word'");
      EXPECT_LT(in_quotes(std::string(300000, 'x')).size(), 80u);
    }

    TEST(MessageText, AMessageKeepsBothEnds)
    {
      EXPECT_EQ(message_text("one\n  two\nthree"), "one\n  two\\x0athree");
      const std::string message = "where: '" + std::string(300000, 'x') + "' is wrong. Remedy.";
      const std::string shown   = message_text(message);
      EXPECT_LT(shown.size(), 3000u);
      EXPECT_EQ(shown.substr(0, 8), "where: '");
      EXPECT_EQ(shown.substr(shown.size() - 7), "Remedy.");
      // characters stay whole
      std::string umlauts;
      for (unsigned int i = 0; i < 5001; ++i)
        umlauts += i == 2000 ? "a" : "\u00e4";
      EXPECT_EQ(find_unprintable(message_text(umlauts)), std::string::npos);
      EXPECT_EQ(find_unprintable(message_text("a" + umlauts)), std::string::npos);
    }
  } // namespace
} // namespace Exemplar::Testing
