// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/loop_parts.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <mutex>
#include <pthread.h>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace Exemplar
{
  namespace
  {
    using Clock = std::chrono::steady_clock;

    /// Time for which a waiting thread spins, about that of falling asleep and waking up; then it
    /// sleeps and leaves its core to others.
    constexpr std::chrono::microseconds patience(50);

    template <typename Condition>
    void
    look_for(const Condition &condition)
    {
      for (const auto end = Clock::now() + patience; !condition() && Clock::now() < end;)
      {
#ifdef __x86_64__
        __builtin_ia32_pause();
#endif
      }
    }

    /// Tasks shared by several threads. Members that are not atomic are guarded by the lock of the
    /// team.
    class SharedTasks
    {
    public:
      SharedTasks(const int n, const int n_threads, const std::function<void(int, int)> &task)
          : n(n), max_helpers(std::min(n, n_threads) - 1), task(task)
      {
      }

      /// Run tasks until all have been begun.
      void
      work(const int thread)
      {
        for (int i = begun++; i < n; i = begun++)
          try
          {
            task(i, thread);
          }
          catch (...)
          {
            keep_failure(i);
          }
      }

      bool
      want_helpers() const
      {
        return n_joined < max_helpers && begun < n;
      }

      /// Rethrow the first failure, once no thread is at work.
      void
      throw_failure() const
      {
        if (failure)
          std::rethrow_exception(failure);
      }

      const int        n;
      const int        max_helpers;
      int              n_joined = 0;   ///< helpers so far
      std::atomic<int> n_helpers{ 0 }; ///< helpers at work

    private:
      void
      keep_failure(const int i)
      {
        const std::lock_guard<std::mutex> lock(failure_mutex);
        if (i < failed)
          failure = std::current_exception();
        failed = std::min(failed, i);
      }

      const std::function<void(int, int)> &task;
      std::atomic<int>                     begun{ 0 };
      std::mutex                           failure_mutex;
      int                                  failed = n; ///< first task that failed
      std::exception_ptr                   failure;
    };

    /// The pool of helping threads: as many as a call has ever asked for. They never end.
    class ThreadTeam
    {
    public:
      void
      share(SharedTasks &tasks)
      {
        offer(tasks);
        tasks.work(0);
        withdraw(tasks);
        tasks.throw_failure();
      }

    private:
      void
      offer(SharedTasks &tasks)
      {
        {
          const std::lock_guard<std::mutex> lock(mutex);
          while (n_threads < tasks.max_helpers && start_thread())
            ++n_threads;
          offered.push_back(&tasks);
          ++n_offers;
        }
        for (int i = 0; i < tasks.max_helpers; ++i)
          has_offer.notify_one();
      }

      /// Stop helpers from joining, and wait for those that have joined.
      void
      withdraw(SharedTasks &tasks)
      {
        std::unique_lock<std::mutex> lock(mutex);
        offered.erase(std::find(offered.begin(), offered.end(), &tasks));
        const auto all_have_left = [&] { return tasks.n_helpers == 0; };
        if (all_have_left())
          return;
        lock.unlock();
        look_for(all_have_left);
        lock.lock();
        has_left.wait(lock, all_have_left);
      }

      /// Start another helper; returns whether there is one. Signals are left to other threads.
      bool
      start_thread()
      {
        sigset_t all, before;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        bool has_started = true;
        try
        {
          std::thread([this] { help(); }).detach();
        }
        catch (const std::system_error &) // no further thread: the others do the tasks
        {
          has_started = false;
        }
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
        return has_started;
      }

      [[noreturn]] void
      help()
      {
        for (;;)
        {
          const auto [tasks, thread] = join();
          tasks->work(thread);
          {
            const std::lock_guard<std::mutex> lock(mutex);
            --tasks->n_helpers; // from here on the tasks may be destroyed
          }
          has_left.notify_all();
        }
      }

      /// The next tasks to be done, and this thread's number in them.
      std::pair<SharedTasks *, int>
      join()
      {
        for (std::unique_lock<std::mutex> lock(mutex);;)
        {
          for (SharedTasks *tasks : offered)
            if (tasks->want_helpers())
            {
              ++tasks->n_helpers;
              return { tasks, ++tasks->n_joined };
            }
          const auto is_new = [this, seen = n_offers.load()] { return n_offers != seen; };
          lock.unlock();
          look_for(is_new);
          lock.lock();
          has_offer.wait(lock, is_new);
        }
      }

      std::mutex                 mutex;
      std::condition_variable    has_offer, has_left;
      std::vector<SharedTasks *> offered;
      std::atomic<unsigned int>  n_offers{ 0 }; ///< offers so far
      int                        n_threads = 0;
    };

    /// The team is never destroyed, as a process may end while its threads wait. A copy of the
    /// process (fork) has none of the threads and begins with another team.
    ThreadTeam *team = new ThreadTeam;

    const int replaced_at_fork = pthread_atfork(nullptr, nullptr, [] { team = new ThreadTeam; });
  } // namespace

  void
  share_tasks(const int n, const int n_threads, const std::function<void(int i, int thread)> &task)
  {
    SharedTasks tasks(n, n_threads, task);
    team->share(tasks);
  }
} // namespace Exemplar
