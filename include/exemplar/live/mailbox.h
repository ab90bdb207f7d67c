// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_mailbox_h
#define exemplar_live_mailbox_h

#include <exemplar/live/command.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <vector>

namespace Exemplar::Live
{
  /// Commands on their way from the thread of the network to that of the solver.
  class Mailbox
  {
  public:
    /// Appends a command. Of several moves of one pointer that were not taken yet, only the newest
    /// is kept. Returns whether there was room.
    bool
    put(Command command);

    /// Takes all commands, oldest first. If `waits`, blocks until there is one, viewers came or
    /// went, stop() was called, or the time is `until`.
    std::vector<Command>
    take(bool waits, std::chrono::steady_clock::time_point until);

    /// Ends take(): the simulation is to stop.
    void
    stop();

    bool
    is_stopped() const;

    /// Sets the number of viewers.
    void
    set_n_viewers(unsigned int n);

    unsigned int
    get_n_viewers() const;

  private:
    mutable std::mutex      mutex;
    std::condition_variable news;
    std::vector<Command>    commands;
    unsigned int            n_viewers       = 0;
    bool                    viewers_are_new = false;
    bool                    has_ended       = false;
  };
} // namespace Exemplar::Live

#endif
