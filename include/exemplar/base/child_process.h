// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_child_process_h
#define exemplar_child_process_h

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// How a process ended.
  struct ChildEnd
  {
    int    exit_status   = 0; ///< 128 + signal if it was killed by one, as in shells
    int    signal        = 0; ///< that ended it, or 0
    bool   timed_out     = false;
    bool   said_too_much = false;
    double seconds       = 0.; ///< on the wall clock
  };

  /// The exit status if there is no such program.
  constexpr int no_such_program = 127;

  /// Run a program (found in PATH, like in a shell) to its end, its output and errors going
  /// to `log`. It is killed after `timeout` seconds (0: never), when this process ends in
  /// whatever way, and once `stop` returns true, upon which this throws Interrupted; `stop` is
  /// asked every few milliseconds. Needs the status of children: SIGCHLD must not be ignored.
  ChildEnd
  run_child(const std::vector<std::string> &command,
            const std::filesystem::path    &log,
            double                          timeout,
            const std::function<bool()>    &stop = {});

  /// How a process ended, and its output and errors.
  struct ChildOutput
  {
    ChildEnd    end;
    std::string text;
  };

  /// What a process may do whose output is returned.
  struct ChildLimits
  {
    std::filesystem::path directory;        ///< in which it runs
    double                timeout;          ///< [s]; 0: none
    std::uintmax_t        max_output_bytes; ///< of its output and errors
  };

  /// As run_child(), but what the program says is returned, not logged. Beyond a limit it is
  /// killed. What it has started itself, and has not taken out of its process group, does not
  /// outlive it.
  ChildOutput
  output_of_child(const std::vector<std::string> &command, const ChildLimits &limits);
} // namespace Exemplar

#endif
