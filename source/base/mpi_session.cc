// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/mpi_session.h>

#include <cstdlib>
#include <mpi.h>
#include <mutex>

namespace Exemplar
{
  namespace
  {
    bool mpi_may_be_started = false, mpi_was_started = false;

    void
    start_mpi()
    {
      // a single process of Open MPI would start a daemon, and look for ssh to do so
      setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
      // hwloc, which inspects the machine, would report on stderr what it misses, such as /sys
      setenv("HWLOC_HIDE_ERRORS", "2", 0);
      // yield the core while waiting for another process: cores may be shared
      setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
      // threads call MPI one after the other: TrilinosLock
      int provided = 0;
      MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED,
                      &provided); // aborts if it fails
      mpi_was_started = true;
    }
  } // namespace

  MpiSession::MpiSession()
  {
    mpi_may_be_started = true;
  }

  MpiSession::~MpiSession()
  {
    if (mpi_was_started)
      MPI_Finalize();
    mpi_may_be_started = mpi_was_started = false;
  }

  void
  MpiSession::require()
  {
    static std::mutex                 one_at_a_time; // MPI starts once, whichever thread is first
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    int                               has_started = 0, has_ended = 0;
    MPI_Initialized(&has_started);
    MPI_Finalized(&has_ended);
    if (has_ended != 0)
      throw UserError("Solver/Linear solver = iterative needs MPI, which has ended in this process "
                      "and cannot start again. Call MPI_Finalize, or let the Exemplar::MpiSession "
                      "end, when the last problem is solved.");
    if (has_started != 0)
      return;
    if (!mpi_may_be_started)
      throw UserError("Solver/Linear solver = iterative needs MPI, which this program has not "
                      "started. Call MPI_Init before, or hold an Exemplar::MpiSession in main().");
    start_mpi();
  }
} // namespace Exemplar
