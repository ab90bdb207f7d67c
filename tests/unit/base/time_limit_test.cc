// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/time_limit.h>

#include <gtest/gtest.h>

#include <csignal>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// What a process that does this goes beyond first.
    template <typename Work>
    std::string
    exceeded_by(const double limit, const Work &work)
    {
      const TimeLimit time(limit);
      const pid_t     process = fork();
      if (process == 0)
        for (volatile bool goes_on = true;
             goes_on;) // a loop without effects may be taken for one that ends
          work();
      std::optional<std::string> exceeded;
      while (!exceeded)
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        exceeded = time.exceeded_by(process);
      }
      kill(process, SIGKILL);
      waitpid(process, nullptr, 0);
      return *exceeded;
    }

    TEST(TimeLimitTest, WorkCountsByTheProcessorAndSleepByTheClock)
    {
      EXPECT_EQ(exceeded_by(0.2, [] {}), "0.2 s of processor time");
      EXPECT_EQ(exceeded_by(0.02, [] { pause(); }), "0.6 s");
    }

    TEST(TimeLimitTest, ChildrenThatHaveEndedCount)
    {
      const auto by_child = []
      {
        const pid_t child = fork();
        if (child == 0)
          for (const clock_t begin = clock(); clock() - begin < CLOCKS_PER_SEC / 10;)
            ;
        if (child == 0)
          _exit(0);
        waitpid(child, nullptr, 0);
      };
      EXPECT_EQ(exceeded_by(0.2, by_child), "0.2 s of processor time");
    }

    TEST(TimeLimitTest, AnEndedProcessHasUsedWhatItHas)
    {
      const TimeLimit time(60.);
      EXPECT_FALSE(time.exceeded_by(getpid()).has_value());
      EXPECT_GE(time.seconds(), 0.);
    }
  } // namespace
} // namespace Exemplar::Testing
