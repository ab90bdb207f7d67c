// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_joint_run_h
#define exemplar_joint_run_h

#include <exemplar/base/process_group.h>

#include <functional>
#include <string>

namespace Exemplar
{
  /// The processes that mpirun has started to run this program together: how they find each other,
  /// and how all end when one fails. main() holds an MpiSession meanwhile.
  class JointRun
  {
  public:
    /// Start MPI if mpirun, mpiexec or srun has started this process together with others; else
    /// nothing happens. Throws UserError, the same in all processes, if they do not find each other
    /// or do not run the same program with the same arguments.
    static void
    join(int argc, char *argv[]);

    /// The processes that have joined: one, if mpirun has not started several. Its wait_for_all()
    /// ends all if a process fails meanwhile.
    static const ProcessGroup &
    group();

    /// To be called by all processes: throws UserError in all of them if `text` is not the same.
    /// `difference` says what is wrong with a process, as in "was given other arguments than".
    static void
    require_same(const std::string &text, const std::string &difference, const std::string &remedy);

    /// How a program ends after join(), in all processes, whether these succeed (status 0) or fail.
    /// What it returns is to be returned by main(). If several processes fail, one of them calls
    /// `report`, which shows the message and behind it what it is given, the place of the process; and the
    /// status of that one becomes that of all. A process that fails while others wait for it ends them
    /// after two seconds, and does not return.
    static int
    end(int status, const std::function<void(const std::string &where)> &report);
  };
} // namespace Exemplar

#endif
