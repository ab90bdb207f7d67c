// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_command_line_h
#define exemplar_command_line_h

namespace Exemplar
{
  /// Execute the command line and return the exit status. Throws the commands' exceptions.
  int
  run_command_line(int argc, char *argv[]);
} // namespace Exemplar

#endif
