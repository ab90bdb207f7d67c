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
  /// A queue of jobs, run one after the other in the order of submission, while the caller goes on.
  /// A job owns its data, or shares data that nobody changes. If one throws, those behind it are
  /// dropped, and from then on submit() and drain() throw its exception.
  class BackgroundWriter
  {
  public:
    /// Greatest number of jobs that wait while another runs.
    static constexpr unsigned int max_waiting = 2;

    /// With `has_thread` jobs run in a thread, which starts with the first job; otherwise submit()
    /// runs them.
    explicit BackgroundWriter(bool has_thread);

    BackgroundWriter(const BackgroundWriter &) = delete;
    BackgroundWriter &
    operator=(const BackgroundWriter &)
        = delete;

    /// Runs the remaining jobs. Their errors are lost: call drain() before.
    ~BackgroundWriter();

    /// Returns once no more than `max_waiting` jobs wait.
    void
    submit(std::function<void()> job);

    /// Returns when every job is done.
    void
    drain();

  private:
    /// The function of the thread.
    void
    work();

    void
    throw_error() const;

    const bool                        has_thread;
    std::mutex                        mutex; ///< guards the members below
    std::condition_variable           changed;
    std::deque<std::function<void()>> waiting;
    bool                              busy    = false; ///< a job is running
    bool                              closing = false;
    std::exception_ptr                error;
    std::thread                       thread;
  };
} // namespace Exemplar

#endif
