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
    int         signal      = 0; ///< that ended it, or 0
    std::string exceeded;        ///< the limit upon which it was killed, as TimeLimit says it
    double      seconds = 0.;    ///< on the wall clock
  };

  /// The exit status if there is no such program.
  constexpr int no_such_program = 127;

  /// Run a program (found in PATH, like in a shell) to its end, its output and errors going
  /// to `log`. It is killed beyond a TimeLimit of `timeout` (0: never), when this process ends in
  /// whatever way, and once `stop` returns true, upon which this throws Interrupted; `stop` is
  /// asked every few milliseconds. Needs the status of children: SIGCHLD must not be ignored.
  ChildEnd
  run_child(const std::vector<std::string> &command,
            const std::filesystem::path    &log,
            double                          timeout,
            const std::function<bool()>    &stop = {});
} // namespace Exemplar

#endif
