// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/process_copy.h>
#include <exemplar/base/shared_value.h>

#include "expect_contains.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>
#include <vector>

namespace Exemplar::Testing
{
  namespace
  {
    std::string
    in_copy(const std::function<std::string()> &work, const double timeout = 60.)
    {
      return in_process_copy(work, { "The work", "Try less.", timeout });
    }

    template <typename Error>
    std::string
    error_in_copy(const std::function<std::string()> &work, const double timeout = 60.)
    {
      try
      {
        in_copy(work, timeout);
      }
      catch (const Error &error)
      {
        return error.what();
      }
      return "no such error";
    }

    TEST(ProcessCopyTest, WhatIsReturnedOrThrownThereComesHere)
    {
      const std::string all = std::string(300000, 'x') + '\0' + "y";
      EXPECT_EQ(in_copy([&] { return all; }), all);
      EXPECT_EQ(in_copy([] { return std::string(); }), "");
      const auto throwing = [](auto error) { return [error]() -> std::string { throw error; }; };
      EXPECT_EQ(error_in_copy<UserError>(throwing(UserError("bad input"))), "bad input");
      EXPECT_EQ(error_in_copy<SolverFailure>(throwing(SolverFailure("failed"))), "failed");
      EXPECT_EQ(error_in_copy<std::runtime_error>(throwing(std::runtime_error("odd"))), "odd");
      EXPECT_THROW(in_copy(throwing(std::bad_alloc())), std::bad_alloc);
    }

    TEST(ProcessCopyTest, WhatItHasComeToIsSeenMeanwhile)
    {
      SharedValue<int>  at(0);
      std::vector<int>  seen;
      const std::string answer = in_process_copy(
          [&]
          {
            at.store(7);
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
            return std::string("done");
          },
          { "The work", "Try less.", 60., [&] { seen.push_back(at.load()); } });
      EXPECT_EQ(answer, "done");
      ASSERT_FALSE(seen.empty());
      EXPECT_EQ(seen.back(), 7);
    }

    TEST(ProcessCopyTest, NothingThereChangesAnythingHere)
    {
      int here = 1;
      EXPECT_EQ(in_copy(
                    [&]
                    {
                      here = 2;
                      return std::to_string(here);
                    }),
                "2");
      EXPECT_EQ(here, 1);
    }

    TEST(ProcessCopyTest, CrashesAndEndlessLoopsBecomeFailures)
    {
      const std::string crashed = "The work crashed in a library that it uses. Try less.";
      EXPECT_EQ(error_in_copy<SolverFailure>(
                    []() -> std::string
                    {
                      std::signal(SIGSEGV, SIG_DFL);
                      std::raise(SIGSEGV);
                      return "";
                    }),
                crashed);
      EXPECT_EQ(error_in_copy<SolverFailure>([]() -> std::string { std::abort(); }), crashed);
      EXPECT_EQ(error_in_copy<SolverFailure>([]() -> std::string { std::_Exit(0); }), crashed);
      expect_contains(error_in_copy<SolverFailure>(
                          []() -> std::string
                          {
                            for (;;)
                              pause();
                          },
                          0.02),
                      "The work did not come to an end within 0.6 s and was ended. Try less.");
      expect_contains(error_in_copy<SolverFailure>(
                          []() -> std::string
                          {
                            volatile unsigned int count = 0; // an endless loop has to do something
                            for (;;)
                              count = count + 1;
                          },
                          0.2),
                      "The work did not come to an end within 0.2 s of processor time and was");
      EXPECT_EQ(error_in_copy<SolverFailure>([]() -> std::string { std::exit(0); }), crashed);
    }

    TEST(ProcessCopyTest, MessagesComeHereUpToALimit)
    {
      const CopyTask task{ "The work", "Try less.", 60. };
      CopyMessages   messages{ 1 << 20 };
      EXPECT_EQ(in_process_copy(
                    []
                    {
                      std::fputs("one\n", stderr);
                      EXPECT_EQ(std::system("echo two; sleep 1000 &"), 0); // who holds our pipe
                      return std::string("done");
                    },
                    task, &messages),
                "done");
      EXPECT_EQ(messages.text, "one\ntwo\n");
      try
      {
        in_process_copy(
            []() -> std::string
            {
              for (;;)
                std::fputs("again and again\n", stderr);
            },
            task, &messages);
        ADD_FAILURE();
      }
      catch (const SolverFailure &failure)
      {
        expect_contains(failure.what(), "The work wrote more than 1 MiB of messages");
      }
    }

    TEST(ProcessCopyTest, ItHasNoneOfTheFilesThatAreOpenHere)
    {
      EXPECT_EQ(in_copy(
                    []
                    {
                      std::string found;
                      for (int i = 4; i < 1000; ++i)
                        if (fcntl(i, F_GETFD) >= 0)
                          found += std::to_string(i) + " ";
                      return found;
                    }),
                "");
    }
  } // namespace
} // namespace Exemplar::Testing
