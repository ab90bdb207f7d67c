// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/interrupt.h>

#include <atomic>
#include <csignal>

namespace Exemplar
{
  namespace
  {
    // the signal may come to any thread
    std::atomic<bool> interrupted{ false };
    static_assert(std::atomic<bool>::is_always_lock_free, "as signal handlers need it");

    void
    note(const int signal)
    {
      interrupted = true;
      std::signal(signal, SIG_DFL); // a second one ends the program at once
    }
  } // namespace

  void
  note_interrupts()
  {
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
  }

  bool
  is_interrupted()
  {
    return interrupted;
  }

  void
  check_interrupt()
  {
    if (interrupted)
      throw Interrupted("Interrupted.");
  }
} // namespace Exemplar
