// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_program_h
#define exemplar_run_program_h

namespace Exemplar
{
  /// What the command line asks for, with a message for what fails; the exit status.
  int
  run_program(int argc, char *argv[]);
} // namespace Exemplar

#endif
