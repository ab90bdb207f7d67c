// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/program/interrupt.h>

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
    note_interrupt(const int signal)
    {
      interrupted = true;
      std::signal(signal, SIG_DFL); // a second one ends the program at once
    }

    bool
    note_interrupts()
    {
      std::signal(SIGINT, note_interrupt);
      std::signal(SIGTERM, note_interrupt);
      return true;
    }
  } // namespace

  bool
  is_interrupted()
  {
    static const bool noting = note_interrupts();
    return noting && interrupted;
  }
} // namespace Exemplar
