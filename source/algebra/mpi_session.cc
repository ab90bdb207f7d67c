// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/mpi_session.h>
#include <exemplar/base/errors.h>

#include <cstdlib>
#include <mpi.h>

namespace Exemplar
{
  namespace
  {
    bool mpi_may_be_started = false, mpi_was_started = false;
  } // namespace

  MpiSession::MpiSession()
  {
    mpi_may_be_started = true;
    if (n_processes() > 1)
      require();
  }

  MpiSession::~MpiSession()
  {
    if (mpi_was_started)
      MPI_Finalize();
    mpi_may_be_started = mpi_was_started = false;
  }

  unsigned int
  MpiSession::n_processes()
  {
    const char *size = std::getenv("OMPI_COMM_WORLD_SIZE");
    return size == nullptr ? 1 : std::atoi(size);
  }

  bool
  MpiSession::is_root()
  {
    int rank = 0;
    if (n_processes() > 1)
      MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank == 0;
  }

  void
  MpiSession::require()
  {
    int is_running = 0;
    MPI_Initialized(&is_running);
    if (is_running != 0)
      return;
    if (!mpi_may_be_started)
      throw UserError("Solver/Linear solver = iterative needs MPI, which this program has not "
                      "started. Call MPI_Init before, or hold an Exemplar::MpiSession in main().");
    // alone, Open MPI would start a daemon, and look for ssh to do so
    if (n_processes() == 1)
      setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    // hwloc, by which it looks at the machine, would say on stderr what it misses, such as /sys
    setenv("HWLOC_HIDE_ERRORS", "2", 0);
    MPI_Init(nullptr, nullptr); // does not return if it fails
    mpi_was_started = true;
  }
} // namespace Exemplar
