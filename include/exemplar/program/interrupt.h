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
} // namespace Exemplar

#endif
