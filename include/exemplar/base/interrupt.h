// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_interrupt_h
#define exemplar_interrupt_h

namespace Exemplar
{
  /// From now on Ctrl-C and SIGTERM are only noted; check_interrupt() acts on them.
  void
  note_interrupts();

  /// Whether Ctrl-C or SIGTERM has come.
  bool
  is_interrupted();

  /// Throws Interrupted if Ctrl-C or SIGTERM has come.
  void
  check_interrupt();
} // namespace Exemplar

#endif
