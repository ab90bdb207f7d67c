// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mpi_session_h
#define exemplar_mpi_session_h

namespace Exemplar
{
  /// The right to start MPI, which a program gives by an object in its main(): multigrid needs
  /// MPI even in one process, and starting it takes a tenth of a second, so that it is started
  /// when the first multigrid operator is made. What was started here ends with this object,
  /// which must outlive these operators. Where MPI runs already, by MPI_Init of a host program,
  /// no such object is needed, and one that is there neither starts nor ends anything.
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
  };
} // namespace Exemplar

#endif
