// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_command_line_h
#define exemplar_command_line_h

namespace Exemplar
{
  /// Do what the command line asks for and return the exit status. Throws what the
  /// commands throw.
  int
  run_command_line(int argc, char *argv[]);
} // namespace Exemplar

#endif
