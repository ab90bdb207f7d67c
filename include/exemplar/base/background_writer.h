// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_background_writer_h
#define exemplar_background_writer_h

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace Exemplar
{
  /// Does jobs one after the other, in the order in which they come, while the caller
  /// goes on. A job owns its data, or shares what nobody changes. If one throws, those
  /// behind it are forgotten, and from then on submit() and drain() throw what it threw.
  class BackgroundWriter
  {
  public:
    /// Jobs that may wait while another is done.
    static constexpr unsigned int max_waiting = 2;

    /// With a thread of its own, which starts with the first job, or with none: then
    /// submit() does the job.
    explicit BackgroundWriter(bool has_thread);

    BackgroundWriter(const BackgroundWriter &) = delete;
    BackgroundWriter &
    operator=(const BackgroundWriter &)
        = delete;

    /// Does the jobs that are left. Nobody learns of their errors: drain() before.
    ~BackgroundWriter();

    /// Returns once no more than `max_waiting` jobs wait.
    void
    submit(std::function<void()> job);

    /// Returns when every job is done.
    void
    drain();

  private:
    /// What the thread does.
    void
    work();

    void
    throw_error() const;

    const bool                        has_thread;
    std::mutex                        mutex; ///< guards the members below
    std::condition_variable           changed;
    std::deque<std::function<void()>> waiting;
    bool                              busy    = false; ///< a job has been taken and is not done
    bool                              closing = false;
    std::exception_ptr                error;
    std::thread                       thread;
  };
} // namespace Exemplar

#endif
