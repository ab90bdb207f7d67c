// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_interrupt_h
#define exemplar_interrupt_h

namespace Exemplar
{
  /// From now on Ctrl-C, SIGTERM, SIGXCPU and SIGHUP (unless nohup has it ignored) end the program at
  /// once with a message and status 130. To be called first in main().
  void
  end_at_interrupts();

  /// Whether such a signal has come since the first call. From that call on the first one is only
  /// noted, so that a run can save what it has, and a second one ends the program.
  bool
  is_interrupted();

  /// Among several processes a first signal is only noted from now on, as the others must hear of it, and so
  /// is SIGUSR1: after other signals mpirun leaves processes a second to live, but passes this one on. At a
  /// second one the process ends, and only one `that_speaks` says so.
  void
  note_interrupts_together(bool that_speaks);
} // namespace Exemplar

#endif
