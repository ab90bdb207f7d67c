// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_interrupt_h
#define exemplar_interrupt_h

namespace Exemplar
{
  /// Whether Ctrl-C or SIGTERM has come since the first call. Until that call they end the
  /// program as usual; after it the first one is only noted, and a second one ends the program.
  bool
  is_interrupted();
} // namespace Exemplar

#endif
