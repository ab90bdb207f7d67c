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
    // atomic, as a signal may arrive in any thread
    std::atomic<bool> noting{ false }, interrupted{ false }, speaking{ true };
    static_assert(std::atomic<bool>::is_always_lock_free, "as signal handlers need it");

    constexpr int signals[] = { SIGINT, SIGTERM, SIGXCPU, SIGHUP };

    /// Exit from a signal handler, where only system calls are safe.
    [[noreturn]] void
    end_with(const char *message)
    {
      if (speaking && write(STDERR_FILENO, message, std::strlen(message)) < 0)
        _exit(130); // no reader; exit all the same
      _exit(130);
    }

    void
    take_interrupt(const int signal)
    {
      // re-install: METIS uses SIGTERM itself and leaves a one-shot handler behind
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
    // unblock signals that were blocked while the program restarted itself
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
