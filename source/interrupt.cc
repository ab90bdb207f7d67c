// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/errors.h>
#include <exemplar/interrupt.h>

#include <csignal>

namespace Exemplar
{
  namespace
  {
    volatile std::sig_atomic_t interrupted = 0;

    void
    note(const int signal)
    {
      interrupted = 1;
      std::signal(signal, SIG_DFL); // a second one ends the program at once
    }
  } // namespace

  void
  note_interrupts()
  {
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
  }

  void
  check_interrupt()
  {
    if (interrupted != 0)
      throw Interrupted("Interrupted.");
  }
} // namespace Exemplar
