// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_child_process_h
#define exemplar_child_process_h

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// How a process ended.
  struct ChildEnd
  {
    int         exit_status = 0; ///< 128 + signal if it was killed by one, as in shells
    int         signal      = 0; ///< signal that ended it, or 0
    std::string exceeded;        ///< the limit for which it was killed, by TimeLimit
    double      seconds = 0.;    ///< wall-clock time
  };

  /// The exit status if there is no such program.
  constexpr int no_such_program = 127;

  /// Run a program (found in PATH, as in a shell) to its end, with its output and errors written to
  /// `log`. It is killed beyond a TimeLimit of `timeout` (0: never), when this process ends in
  /// whatever way, and once `stop` returns true, upon which this throws Interrupted; `stop` is
  /// called every few milliseconds. Needs the status of children: SIGCHLD must not be ignored.
  ChildEnd
  run_child(const std::vector<std::string> &command,
            const std::filesystem::path    &log,
            double                          timeout,
            const std::function<bool()>    &stop = {});
} // namespace Exemplar

#endif
