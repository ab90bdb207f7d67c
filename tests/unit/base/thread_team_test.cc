// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/loop_parts.h>
#include <exemplar/base/process_copy.h>

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace Exemplar::Testing
{
  namespace
  {
    /// How often each of n tasks was done.
    std::vector<int>
    times_done(const int n, const int n_threads)
    {
      std::vector<int> times(n, 0);
      for_each_task(n, n_threads, [&](const int i, int) { ++times[i]; });
      return times;
    }

    TEST(ThreadTeamTest, EachTaskIsDoneOnce)
    {
      for (const int n_threads : { 1, 2, 3, 4, 40 })
        for (const int n : { 0, 1, 2, 3, 100 })
          for (int i = 0; i < 100; ++i)
            ASSERT_EQ(times_done(n, n_threads), std::vector<int>(n, 1)) << n << " " << n_threads;
    }

    TEST(ThreadTeamTest, PartsAreThoseOfOneThread)
    {
      for (const int n_threads : { 1, 2, 3, 4 })
      {
        std::vector<std::size_t> begins(3), ends(3);
        for_each_part(3, 10, n_threads,
                      [&](const std::size_t part, const std::size_t begin, const std::size_t end)
                      {
                        begins[part] = begin;
                        ends[part]   = end;
                      });
        EXPECT_EQ(begins, (std::vector<std::size_t>{ 0, 3, 6 }));
        EXPECT_EQ(ends, (std::vector<std::size_t>{ 3, 6, 10 }));
      }
    }

    TEST(ThreadTeamTest, EachOfThoseAtWorkHasItsNumber)
    {
      std::mutex                mutex;
      std::set<int>             numbers;
      std::set<std::thread::id> threads;
      const auto                here = std::this_thread::get_id();
      for_each_task(3, 3,
                    [&](int, const int thread)
                    {
                      {
                        const std::lock_guard<std::mutex> lock(mutex);
                        EXPECT_EQ(thread == 0, std::this_thread::get_id() == here);
                        numbers.insert(thread);
                        threads.insert(std::this_thread::get_id());
                      }
                      for (;;) // until all three have begun
                      {
                        const std::lock_guard<std::mutex> lock(mutex);
                        if (threads.size() == 3)
                          return;
                      }
                    });
      EXPECT_EQ(numbers, (std::set<int>{ 0, 1, 2 }));
    }

    TEST(ThreadTeamTest, TasksShareTasks)
    {
      std::atomic<int> sum{ 0 };
      for (int i = 0; i < 100; ++i)
        for_each_task(5, 3,
                      [&](const int a, int)
                      { for_each_task(7, 3, [&](const int b, int) { sum += 10 * a + b; }); });
      EXPECT_EQ(sum, 100 * (10 * 10 * 7 + 21 * 5));
    }

    TEST(ThreadTeamTest, SeveralThreadsShareTasksAtOnce)
    {
      std::vector<std::thread> callers;
      std::atomic<int>         n_right{ 0 };
      for (int k = 0; k < 4; ++k)
        callers.emplace_back(
            [&]
            {
              for (int i = 0; i < 200; ++i)
                n_right += times_done(20, 3) == std::vector<int>(20, 1) ? 1 : 0;
            });
      for (std::thread &caller : callers)
        caller.join();
      EXPECT_EQ(n_right, 800);
    }

    TEST(ThreadTeamTest, WhatTheFirstTaskThrowsComesHere)
    {
      for (const int n_threads : { 1, 2, 4 })
        for (int k = 0; k < 50; ++k)
          try
          {
            for_each_task(20, n_threads,
                          [&](const int i, int)
                          {
                            if (i % 7 == 3)
                              throw std::runtime_error("task " + std::to_string(i));
                          });
            ADD_FAILURE();
          }
          catch (const std::runtime_error &error)
          {
            EXPECT_STREQ(error.what(), "task 3");
          }
    }

    TEST(ThreadTeamTest, NobodyWaitsForAThreadThatIsBusyElsewhere)
    {
      // in a copy of the process nobody else has asked for threads, and there is one beside the callers
      const auto in_copy = []
      {
        std::atomic<int>  n_begun{ 0 };
        std::atomic<bool> may_end{ false };
        std::thread       other(
            [&]
            {
              for_each_task(2, 2,
                                  [&](int, int)
                                  {
                              for (++n_begun; !may_end;)
                                ;
                            });
            });
        while (n_begun < 2)
          ;
        std::string threads;
        for_each_task(3, 2, [&](int, const int thread) { threads += std::to_string(thread); });
        may_end = true;
        other.join();
        return threads;
      };
      EXPECT_EQ(in_process_copy(in_copy, { "Three tasks", "", 10. }), "000");
    }

    TEST(ThreadTeamTest, ACopyOfTheProcessHasThreadsOfItsOwn)
    {
      EXPECT_EQ(times_done(20, 3), std::vector<int>(20, 1));
      const auto in_copy = []
      {
        // the second task ends when the first has begun, in whichever thread
        std::atomic<int> n_begun{ 0 };
        for_each_task(2, 2,
                      [&](int, int)
                      {
                        for (++n_begun; n_begun < 2;)
                          ;
                      });
        return std::to_string(n_begun);
      };
      EXPECT_EQ(in_process_copy(in_copy, { "Two tasks", "", 10. }), "2");
    }
  } // namespace
} // namespace Exemplar::Testing
