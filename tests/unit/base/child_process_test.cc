// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/child_process.h>

#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <csignal>
#include <iterator>

namespace Exemplar::Testing
{
  namespace
  {
    class ChildProcessTest : public InTemporaryDirectory
    {
    protected:
      ChildEnd
      run(const std::vector<std::string> &command, const double timeout = 60.) const
      {
        return run_child(command, directory / "log", timeout);
      }
    };

    TEST_F(ChildProcessTest, OutputAndErrorsAreLogged)
    {
      const ChildEnd end = run({ "sh", "-c", "echo one; echo two >&2; exit 3" });
      std::ifstream  log(directory / "log");
      EXPECT_EQ(std::string(std::istreambuf_iterator<char>(log), {}), "one\ntwo\n");
      EXPECT_EQ(end.exit_status, 3);
      EXPECT_EQ(end.signal, 0);
      EXPECT_EQ(run({ "there is no such program" }).exit_status, no_such_program);
    }

    TEST_F(ChildProcessTest, ItIsEndedAfterItsTime)
    {
      const ChildEnd late = run({ "sleep", "1000" }, 0.02);
      EXPECT_EQ(late.exceeded, "0.6 s");
      EXPECT_EQ(late.signal, SIGKILL);
      EXPECT_EQ(run({ "sh", "-c", "while :; do :; done" }, 0.2).exceeded,
                "0.2 s of processor time");
      EXPECT_EQ(run({ "true" }).exceeded, "");
    }
  } // namespace
} // namespace Exemplar::Testing
