// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_test_expect_contains_h
#define exemplar_test_expect_contains_h

#include <gtest/gtest.h>

#include <string>

namespace Exemplar
{
  inline void
  expect_contains(const std::string &text, const std::string &part)
  {
    EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
  }
} // namespace Exemplar

#endif
