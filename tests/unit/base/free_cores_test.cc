// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/free_cores.h>

#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <limits>
#include <sched.h>
#include <thread>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr double none = std::numeric_limits<double>::infinity();

    /// What is mounted as control groups, made of files.
    class FreeCoresTest : public InTemporaryDirectory
    {
    protected:
      void
      write(const std::string &file, const std::string &text) const
      {
        std::filesystem::create_directories((directory / file).parent_path());
        std::ofstream(directory / file) << text << '\n';
      }

      double
      cores(const std::string &membership) const
      {
        return cores_of_quotas(directory, membership);
      }
    };

    TEST_F(FreeCoresTest, TheLeastQuotaOfAGroupAndThoseAboveCounts)
    {
      write("cpu.max", "max 100000");
      write("a/cpu.max", "250000 100000");
      write("a/b c/cpu.max", "400000 100000");
      write("a/b c/d/cpu.max", "max 100000");
      write("beside/cpu.max", "10000 100000");
      EXPECT_EQ(cores("0::/\n"), none);
      EXPECT_EQ(cores("0::/a/b c/d\n"), 2.5);
      EXPECT_EQ(cores("0::/beside\n"), 0.1);
      EXPECT_EQ(cores("0::/a/there is none\n"), 2.5);
    }

    TEST_F(FreeCoresTest, AContainerSeesItsGroupAtTheTop)
    {
      write("cpu.max", "150000 100000");
      EXPECT_EQ(cores("0::/docker/3f1b\n"), 1.5);
      EXPECT_EQ(cores("0::/../../other\n"), 1.5);
    }

    TEST_F(FreeCoresTest, VersionOneHasAHierarchyOfItsOwnForProcessors)
    {
      write("cpu/cpu.cfs_quota_us", "-1");
      write("cpu/cpu.cfs_period_us", "100000");
      write("cpu/a/cpu.cfs_quota_us", "300000");
      write("cpu/a/cpu.cfs_period_us", "100000");
      write("cpuset/a/cpu.cfs_quota_us", "1");
      write("cpuset/a/cpu.cfs_period_us", "100000");
      EXPECT_EQ(cores("3:cpuset:/a\n2:cpuacct,cpu:/a/b\n1:name=systemd:/x\n0::/\n"), 3.);
      EXPECT_EQ(cores("2:cpu:/b\n"), none);
    }

    TEST_F(FreeCoresTest, WhatCannotBeReadIsNoQuota)
    {
      write("a/cpu.max", "a lot");
      write("b/cpu.max", "100000 0");
      write("c/cpu.max", "");
      for (const std::string text :
           { "0::/a", "0::/b", "0::/c", "0::/d", "", "no colon", "0:", "::" })
        EXPECT_EQ(cores(text), none) << text;
    }

    TEST(FreeCores, AThreadThatIsBoundHasTheCoresItIsBoundTo)
    {
      unsigned int n = 0;
      std::thread(
          [&]
          {
            cpu_set_t all, one;
            sched_getaffinity(0, sizeof all, &all);
            CPU_ZERO(&one);
            for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core)
              if (CPU_ISSET(core, &all))
                CPU_SET(core, &one);
            ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
            n = n_free_cores();
          })
          .join();
      EXPECT_EQ(n, 1U);
      EXPECT_LE(n_free_cores(), std::thread::hardware_concurrency());
    }
  } // namespace
} // namespace Exemplar::Testing
