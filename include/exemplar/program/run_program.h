// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_program_h
#define exemplar_run_program_h

namespace Exemplar
{
  /// Execute the command line, with messages for failures; returns the exit status.
  int
  run_program(int argc, char *argv[]);

  /// Execute the command line and return the exit status. Throws the commands' exceptions.
  int
  run_command_line(int argc, char *argv[]);
} // namespace Exemplar

#endif
