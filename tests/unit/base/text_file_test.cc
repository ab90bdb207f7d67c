// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/text_file.h>

#include "temporary_directory.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    using TextFile = InTemporaryDirectory;

    TEST_F(TextFile, HasAllBytes)
    {
      const std::string bytes("a\r\n\0\xff", 5);
      EXPECT_EQ(read_text_file(write_file("some", bytes)), bytes);
      EXPECT_EQ(read_text_file(write_file("empty", "")), "");
    }

    // /dev/zero has no end, and the bytes of /proc/self/mem cannot be read from its beginning
    TEST_F(TextFile, IsNotReadWhereThatFails)
    {
      for (const char *const file : { "/dev/zero", "/proc/self/mem", "/proc", "/proc/absent" })
      {
        std::string reason;
        EXPECT_EQ(read_text_file(file, &reason), std::nullopt) << file;
        EXPECT_NE(reason, "") << file;
      }
    }
  } // namespace
} // namespace Exemplar::Testing
