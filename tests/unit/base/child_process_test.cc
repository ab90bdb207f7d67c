// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/child_process.h>

#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace Exemplar::Testing
{
  namespace
  {
    class ChildProcessTest : public InTemporaryDirectory
    {
    protected:
      ChildOutput
      shell(const std::string &script, const double timeout = 60.) const
      {
        return output_of_child({ "sh", "-c", script }, { directory, timeout, 1 << 16 });
      }
    };

    TEST_F(ChildProcessTest, OutputAndErrorsAreReturned)
    {
      const ChildOutput found = shell("pwd; echo more >&2; exit 3");
      EXPECT_EQ(found.text, std::filesystem::canonical(directory).string() + "\nmore\n");
      EXPECT_EQ(found.end.exit_status, 3);
      EXPECT_EQ(found.end.signal, 0);
      EXPECT_EQ(output_of_child({ "there is no such program" }, { "/", 1., 10 }).end.exit_status,
                no_such_program);
    }

    TEST_F(ChildProcessTest, ItIsEndedBeyondALimit)
    {
      const ChildOutput late = shell("sleep 1000", 0.05);
      EXPECT_TRUE(late.end.timed_out);
      EXPECT_EQ(late.end.signal, SIGKILL);
      const ChildOutput loud = shell("while true; do echo again and again; done");
      EXPECT_TRUE(loud.end.said_too_much);
      EXPECT_EQ(loud.end.signal, SIGKILL);
    }

    TEST_F(ChildProcessTest, WhatItStartsDoesNotOutliveIt)
    {
      for (const std::string end : { "exit 0", "sleep 1000" })
      {
        const ChildOutput found = shell("sleep 1000 & echo $!; " + end, 0.3);
        const auto        id    = static_cast<pid_t>(std::stol(found.text));
        // its new parent may take a moment to notice
        for (unsigned int i = 0; i < 500 && ::kill(id, 0) == 0; ++i)
        {
          const std::filesystem::path stat = "/proc/" + std::to_string(id) + "/stat";
          std::ifstream               in(stat);
          std::string                 line;
          std::getline(in, line);
          if (line.find(") Z ") != std::string::npos)
            break;
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
          ASSERT_LT(i, 499u) << "still alive";
        }
      }
    }
  } // namespace
} // namespace Exemplar::Testing
