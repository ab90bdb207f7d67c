// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_joint_run_h
#define exemplar_joint_run_h

#include <exemplar/base/process_group.h>

#include <functional>
#include <string>

namespace Exemplar
{
  /// The processes that mpirun has started together: how they connect, and how all end if one
  /// fails. main() holds an MpiSession meanwhile.
  class JointRun
  {
  public:
    /// Start MPI if mpirun, mpiexec or srun has started this process with others; otherwise do
    /// nothing. Throws UserError, the same in all processes, if they cannot connect or run
    /// different programs or arguments.
    static void
    join(int argc, char *argv[]);

    /// The joined processes; one without mpirun. Its wait_for_all() ends all if one fails while
    /// others wait.
    static const ProcessGroup &
    group();

    /// Collective: throws UserError in all processes if `text` differs. `difference` is a phrase of
    /// the message such as "was given other arguments than".
    static void
    require_same(const std::string &text, const std::string &difference, const std::string &remedy);

    /// End of a program after join(), to be called by all processes, with status 0 or that of a
    /// failure; returns the status for main(). If several fail, one of them calls `report` with its
    /// place, to be appended to the message, and its status becomes that of all. A process that
    /// fails while others wait for it aborts them after two seconds, and does not return.
    static int
    end(int status, const std::function<void(const std::string &where)> &report);
  };
} // namespace Exemplar

#endif
