// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_program_h
#define exemplar_live_program_h

namespace Exemplar
{
  /// Go on as exemplar-live, the program beside this one, with the arguments of this one; returns only
  /// by UserError.
  [[noreturn]] void
  become_live_program(char *argv[]);
} // namespace Exemplar

#endif
