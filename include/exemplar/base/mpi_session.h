// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mpi_session_h
#define exemplar_mpi_session_h

namespace Exemplar
{
  /// Permission to start MPI, which a program gives by an object in its main(): multigrid needs MPI
  /// even in one process, and starting it takes a tenth of a second, so that it is started when the
  /// first multigrid operator is made. MPI started here ends with this object, which must outlive
  /// these operators. Where MPI is already running, by MPI_Init of a host program, no such object
  /// is needed, and an existing one neither starts nor ends anything.
  class MpiSession
  {
  public:
    /// Makes the session; at most one at a time.
    MpiSession();

    ~MpiSession();

    MpiSession(const MpiSession &) = delete;
    MpiSession &
    operator=(const MpiSession &)
        = delete;

    /// Ensure that MPI is running, before calls of MPI. Any thread may call this. Throws UserError
    /// if it is not running and there is no session to start it, or if it has ended before.
    static void
    require();
  };
} // namespace Exemplar

#endif
