// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/progress.h>

#include "expect_contains.h"

#include <gtest/gtest.h>

#include <sstream>
#include <thread>

namespace Exemplar::Testing
{
  namespace
  {
    /// What a terminal gets of a run of two steps, of which the second takes long.
    std::string
    shown(const bool quiet)
    {
      std::ostringstream out;
      Progress           progress(out, true, quiet, 0, 2);
      progress.go_on("");
      progress.update(1, "of the first");
      progress.go_on("7 iterations");
      std::this_thread::sleep_for(std::chrono::milliseconds(1300));
      progress.finish();
      return out.str();
    }

    TEST(Progress, ALongStepShowsWhatItHasComeTo)
    {
      const std::string text = shown(false);
      expect_contains(text, "[##########..........] step 2 of 2, 1 s so far, 7 iterations");
      EXPECT_EQ(text.back(), '\n');
    }

    TEST(Progress, OfStepsOfUnlikeTimesNoTimeLeftIsTold)
    {
      std::ostringstream out;
      Progress           progress(out, true, false, 0, 4, "stage");
      for (const unsigned int step : { 1, 3, 3 })
        progress.go_on_with(step, "filling");
      std::this_thread::sleep_for(std::chrono::milliseconds(1300));
      progress.finish();
      expect_contains(out.str(), "[##########..........] stage 3 of 4, 1 s so far, filling");
      EXPECT_EQ(out.str().find("left"), std::string::npos);
    }

    TEST(Progress, QuietStaysQuiet)
    {
      EXPECT_EQ(shown(true), "");
    }

    TEST(Progress, ElsewhereThereAreLinesWithoutEscapes)
    {
      std::ostringstream out;
      {
        Progress progress(out, false, false, 0, 1);
        progress.go_on("1 iteration");
        progress.update(1, "done");
      }
      EXPECT_EQ(out.str(), "step 1 of 1, 0 s left, done\n");
    }
  } // namespace
} // namespace Exemplar::Testing
