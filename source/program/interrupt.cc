// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/program/interrupt.h>

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>

namespace Exemplar
{
  namespace
  {
    // a signal may come to any thread
    std::atomic<bool> noting{ false }, interrupted{ false }, speaking{ true };
    static_assert(std::atomic<bool>::is_always_lock_free, "as signal handlers need it");

    constexpr int signals[] = { SIGINT, SIGTERM, SIGXCPU, SIGHUP };

    /// A signal handler: nothing but system calls is safe.
    [[noreturn]] void
    end_with(const char *message)
    {
      if (speaking && write(STDERR_FILENO, message, std::strlen(message)) < 0)
        _exit(130); // nobody listens, which changes nothing
      _exit(130);
    }

    void
    take_interrupt(const int signal)
    {
      // METIS, which has a use of its own for SIGTERM, leaves behind a handler that serves once
      std::signal(signal, take_interrupt);
      if (!noting)
        end_with("exemplar: Interrupted before a run had begun.\n");
      if (interrupted.exchange(true))
        end_with(
            "exemplar: Interrupted again, and ended at once. Go on from the last checkpoint with "
            "--resume.\n");
    }
  } // namespace

  void
  end_at_interrupts()
  {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : signals)
    {
      sigaddset(&set, signal);
      const auto before = std::signal(signal, take_interrupt);
      if (signal == SIGHUP && before == SIG_IGN)
        std::signal(SIGHUP, SIG_IGN);
    }
    // those that came while the program was started anew have waited
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  }

  bool
  is_interrupted()
  {
    noting = true;
    return interrupted;
  }

  void
  note_interrupts_together(const bool that_speaks)
  {
    noting   = true;
    speaking = that_speaks;
    std::signal(SIGUSR1, take_interrupt);
  }
} // namespace Exemplar
