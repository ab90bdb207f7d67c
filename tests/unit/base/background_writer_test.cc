// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/background_writer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace Exemplar
{
  namespace
  {
    /// With a thread and without.
    class BackgroundWriterTest : public testing::TestWithParam<bool>
    {
    };

    INSTANTIATE_TEST_SUITE_P(Threads, BackgroundWriterTest, testing::Bool());

    void
    take_a_moment()
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    std::vector<int>
    first_numbers(const int n)
    {
      std::vector<int> numbers(n);
      std::iota(numbers.begin(), numbers.end(), 0);
      return numbers;
    }

    template <typename Action>
    std::string
    message_of(const Action &action)
    {
      try
      {
        action();
        return "";
      }
      catch (const std::runtime_error &error)
      {
        return error.what();
      }
    }

    TEST_P(BackgroundWriterTest, DoesJobsInOrder)
    {
      std::vector<int> done;
      BackgroundWriter writer(GetParam());
      writer.drain(); // nothing yet
      for (int i = 0; i < 20; ++i)
      {
        writer.submit(
            [&done, i]
            {
              take_a_moment();
              done.push_back(i);
            });
        if (i % 7 == 6)
        {
          writer.drain();
          EXPECT_EQ(done, first_numbers(i + 1));
        }
      }
      writer.drain();
      EXPECT_EQ(done, first_numbers(20));
    }

    TEST_P(BackgroundWriterTest, UsesAThreadIfItHasOne)
    {
      std::thread::id  thread;
      BackgroundWriter writer(GetParam());
      writer.submit([&thread] { thread = std::this_thread::get_id(); });
      writer.drain();
      EXPECT_EQ(thread != std::this_thread::get_id(), GetParam());
    }

    TEST(BackgroundWriterTest, LetsTheCallerGoOn)
    {
      std::promise<void> caller_went_on;
      std::future_status status = std::future_status::timeout;
      BackgroundWriter   writer(true);
      writer.submit([&]
                    { status = caller_went_on.get_future().wait_for(std::chrono::minutes(1)); });
      for (unsigned int i = 0; i < BackgroundWriter::max_waiting; ++i)
        writer.submit([] {});
      caller_went_on.set_value();
      writer.drain();
      EXPECT_EQ(status, std::future_status::ready);
    }

    TEST(BackgroundWriterTest, IsBounded)
    {
      std::atomic<unsigned int> submitted{ 0 };
      unsigned int              begun = 0, max_waiting = 0;
      BackgroundWriter          writer(true);
      for (unsigned int i = 0; i < 50; ++i)
      {
        writer.submit(
            [&]
            {
              ++begun;
              take_a_moment(); // in which the caller runs ahead
              const unsigned int now = submitted;
              max_waiting            = std::max(max_waiting, now > begun ? now - begun : 0);
            });
        ++submitted;
      }
      writer.drain();
      EXPECT_EQ(begun, 50);
      EXPECT_LE(max_waiting, BackgroundWriter::max_waiting);
    }

    TEST_P(BackgroundWriterTest, ThrowsWhatAJobThrew)
    {
      std::vector<int> done;
      BackgroundWriter writer(GetParam());
      const auto       all = [&]
      {
        for (int i = 0; i < 6; ++i)
          writer.submit(
              [&done, i]
              {
                take_a_moment();
                if (i == 2)
                  throw std::runtime_error("the disk is full");
                done.push_back(i);
              });
        writer.drain();
      };
      EXPECT_EQ(message_of(all), "the disk is full");
      EXPECT_EQ(message_of([&] { writer.drain(); }), "the disk is full");
      EXPECT_EQ(message_of([&] { writer.submit([&] { done.push_back(99); }); }),
                "the disk is full");
      EXPECT_EQ(done, first_numbers(2));
    }

    TEST_P(BackgroundWriterTest, DoesTheRestWhenAnotherExceptionPasses)
    {
      std::vector<int> done;
      EXPECT_EQ(message_of(
                    [&]
                    {
                      BackgroundWriter writer(GetParam());
                      for (int i = 0; i < 3; ++i)
                        writer.submit(
                            [&done, i]
                            {
                              take_a_moment();
                              done.push_back(i);
                            });
                      throw std::runtime_error("no convergence");
                    }),
                "no convergence");
      EXPECT_EQ(done, first_numbers(3));
    }

    TEST(BackgroundWriterTest, EndsWithAnErrorThatNobodyAskedFor)
    {
      BackgroundWriter writer(true);
      writer.submit([] { throw std::runtime_error("the disk is full"); });
    }
  } // namespace
} // namespace Exemplar
