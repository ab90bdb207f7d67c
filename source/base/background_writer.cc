// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/background_writer.h>

#include <utility>

namespace Exemplar
{
  BackgroundWriter::BackgroundWriter(const bool has_thread) : has_thread(has_thread) {}

  BackgroundWriter::~BackgroundWriter()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      closing = true;
    }
    changed.notify_all();
    if (thread.joinable())
      thread.join();
  }

  void
  BackgroundWriter::submit(std::function<void()> job)
  {
    std::unique_lock<std::mutex> lock(mutex);
    throw_error();
    if (!has_thread)
    {
      try
      {
        job();
      }
      catch (...)
      {
        error = std::current_exception();
        throw;
      }
      return;
    }
    if (!thread.joinable())
      thread = std::thread(&BackgroundWriter::work, this);
    waiting.push_back(std::move(job));
    changed.notify_all();
    changed.wait(lock, [this] { return waiting.size() <= max_waiting; });
    throw_error();
  }

  void
  BackgroundWriter::drain()
  {
    std::unique_lock<std::mutex> lock(mutex);
    changed.wait(lock, [this] { return waiting.empty() && !busy; });
    throw_error();
  }

  void
  BackgroundWriter::work()
  {
    std::unique_lock<std::mutex> lock(mutex);
    while (true)
    {
      changed.wait(lock, [this] { return closing || !waiting.empty(); });
      if (waiting.empty())
        return;
      std::function<void()> job = std::move(waiting.front());
      waiting.pop_front();
      busy = true;
      changed.notify_all();

      lock.unlock();
      std::exception_ptr job_error;
      try
      {
        job();
      }
      catch (...)
      {
        job_error = std::current_exception();
      }
      job = nullptr; // frees the job's data while unlocked
      lock.lock();

      busy = false;
      if (job_error)
      {
        error = job_error;
        waiting.clear();
      }
      changed.notify_all();
    }
  }

  void
  BackgroundWriter::throw_error() const
  {
    if (error)
      std::rethrow_exception(error);
  }
} // namespace Exemplar
