// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/process_copy.h>

#include "expect_contains.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <new>

namespace Exemplar::Testing
{
  namespace
  {
    std::string
    in_copy(const std::function<std::string()> &work, const double timeout = 60.)
    {
      return in_process_copy(work, timeout, "The work", "Try less.");
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
                            for (volatile int i = 0;; i = 0)
                              ;
                          },
                          0.),
                      "The work did not come to an end within 0 s and was ended. Try less.");
    }
  } // namespace
} // namespace Exemplar::Testing
