// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_program_h
#define exemplar_live_program_h

namespace Exemplar
{
  /// Replace this process by exemplar-live, the program next to this one, with the same arguments;
  /// returns only by UserError.
  [[noreturn]] void
  become_live_program(char *argv[]);
} // namespace Exemplar

#endif
