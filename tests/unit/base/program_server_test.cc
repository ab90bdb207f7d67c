// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/program_server.h>
#include <exemplar/base/text_file.h>

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <unistd.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// A program that does what its first argument says.
    int
    do_as_told(const int argc, char *argv[])
    {
      const std::string word = argc > 1 ? argv[1] : "";
      if (word == "crash")
        std::raise(SIGSEGV);
      if (word == "wait")
        sleep(60);
      static int n_runs = 0;
      std::cout << word << " " << argc << " " << ++n_runs << std::endl;
      std::cerr << "done" << std::endl;
      return word == "fail" ? 3 : 0;
    }

    class ProgramServerTest : public testing::Test
    {
    protected:
      ChildEnd
      run(const std::vector<std::string> &arguments,
          const double                    timeout = 0.,
          const std::function<bool()>    &stop    = {})
      {
        return server.run(arguments, log, timeout, stop);
      }

      std::string
      said() const
      {
        return read_text_file(log).value_or("");
      }

      void
      TearDown() override
      {
        std::filesystem::remove(log);
      }

      const std::filesystem::path log
          = testing::TempDir() + "program_server_" + std::to_string(getpid()) + ".log";
      ProgramServer server{ do_as_told };
    };

    TEST_F(ProgramServerTest, EachRunBeginsAsTheFirst)
    {
      for (int i = 0; i < 3; ++i)
      {
        const ChildEnd end = run({ "program", "go", std::string(300000, 'x') });
        EXPECT_EQ(end.exit_status, 0);
        EXPECT_EQ(end.signal, 0);
        EXPECT_EQ(said(), "go 3 1\ndone\n");
      }
    }

    TEST_F(ProgramServerTest, TellsHowARunHasEnded)
    {
      EXPECT_EQ(run({ "program", "fail" }).exit_status, 3);
      const ChildEnd crash = run({ "program", "crash" });
      EXPECT_EQ(crash.signal, SIGSEGV);
      EXPECT_EQ(crash.exit_status, 128 + SIGSEGV);
      const ChildEnd late = run({ "program", "wait" }, 0.02);
      EXPECT_EQ(late.exceeded, "0.6 s");
      EXPECT_EQ(late.signal, SIGKILL);
      EXPECT_LT(late.seconds, 30.);
      EXPECT_EQ(run({ "program", "go" }).exit_status, 0); // and goes on
    }

    TEST_F(ProgramServerTest, WhoKillsTheServerKillsTheRun)
    {
      const std::string server_process = read_text_file("/proc/thread-self/children").value_or("");
      ASSERT_GT(std::atoi(server_process.c_str()), 0);
      const auto kill_server = [&]
      {
        kill(std::atoi(server_process.c_str()), SIGSEGV);
        return false;
      };
      EXPECT_EQ(run({ "program", "wait" }, 0., kill_server).signal, SIGSEGV);
      EXPECT_EQ(run({ "/bin/true" }).exit_status, 0); // started as any program
    }

    TEST_F(ProgramServerTest, ARunMayBeStopped)
    {
      EXPECT_THROW(run({ "program", "wait" }, 0., [] { return true; }), Interrupted);
      EXPECT_EQ(run({ "program", "go" }).exit_status, 0);
    }
  } // namespace
} // namespace Exemplar::Testing
