// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mpi_session_h
#define exemplar_mpi_session_h

#include <functional>
#include <string>

namespace Exemplar
{
  /// The right to start MPI, which a program gives by an object in its main(): multigrid needs
  /// MPI even in one process, and starting it takes a tenth of a second, so that it is started
  /// when the first multigrid operator is made. What was started here ends with this object,
  /// which must outlive these operators. Where MPI runs already, by MPI_Init of a host program,
  /// no such object is needed, and one that is there neither starts nor ends anything.
  ///
  /// A program that several processes run together says so by join(), and ends by end().
  class MpiSession
  {
  public:
    /// At most one at a time.
    MpiSession();

    ~MpiSession();

    MpiSession(const MpiSession &) = delete;
    MpiSession &
    operator=(const MpiSession &)
        = delete;

    /// For those who call MPI: it runs afterwards. Any thread may call this. Throws UserError if it
    /// does not run and there is no session to start it, or if it has ended before.
    static void
    require();

    /// Start MPI if mpirun, mpiexec or srun has started this process together with others; else
    /// nothing happens. Throws UserError, the same in all processes, if they do not find each other
    /// or do not run the same program with the same arguments.
    static void
    join(int argc, char *argv[]);

    /// Processes that have joined; 1 if none have.
    static unsigned int
    n_processes();

    /// Which of them this is.
    static unsigned int
    process();

    /// Whether this is the process that prints, and writes files.
    static bool
    is_root()
    {
      return process() == 0;
    }

    /// To be called by all processes: throws UserError in all of them if `text` is not the same.
    /// `difference` says what is wrong with a process, as in "was given other arguments than".
    static void
    require_same(const std::string &text, const std::string &difference, const std::string &remedy);

    /// To be called by all processes: returns when all have called it. A process that fails meanwhile
    /// ends all.
    static void
    wait_for_all();

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
