// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/process_group.h>

#include <gtest/gtest.h>

#include <sstream>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(ProcessGroup, TheRootAloneSpeaksAndActs)
    {
      std::ostringstream out;
      unsigned int       n_acts = 0;
      for (unsigned int process = 0; process < 3; ++process)
      {
        const ProcessGroup group{ 3, process };
        group.of_root(out) << process;
        group.at_root([&] { ++n_acts; });
      }
      EXPECT_EQ(out.str(), "0");
      EXPECT_EQ(n_acts, 1u);
    }
  } // namespace
} // namespace Exemplar::Testing
