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
    /// Of several places of one pointer that nobody has seen yet, the newest wins. Returns whether there
    /// was room.
    bool
    put(Command command);

    /// All commands, oldest first. If `waits`, not before there is one, viewers came or went, stop() was
    /// called, or it is `until`.
    std::vector<Command>
    take(bool waits, std::chrono::steady_clock::time_point until);

    /// Nothing will be wanted any more.
    void
    stop();

    bool
    is_stopped() const;

    /// How many viewers there are.
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
