// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_interrupt_h
#define exemplar_interrupt_h

namespace Exemplar
{
  /// Let Ctrl-C, SIGTERM, SIGXCPU and SIGHUP (unless ignored by nohup) end the program at once with
  /// a message and status 130. Call first in main().
  void
  end_at_interrupts();

  /// Whether one of these signals has arrived since the first call. From that call on, the first
  /// signal is only recorded, so that a run can save its results, and a second one ends the
  /// program.
  bool
  is_interrupted();

  /// For one of several processes: record the first signal and SIGUSR1 without ending, as the
  /// others must learn of it. mpirun kills processes a second after other signals, but passes
  /// SIGUSR1 on. A second signal ends the process, with a message only if `that_speaks`.
  void
  note_interrupts_together(bool that_speaks);
} // namespace Exemplar

#endif
