// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_launcher_h
#define exemplar_launcher_h

#include <string>

namespace Exemplar
{
  /// How mpirun, mpiexec or srun has started this process, by the environment variables that it has
  /// set.
  struct Launch
  {
    std::string  program;         ///< the launcher; empty if there is none
    unsigned int n_processes = 1; ///< number of processes started together; 0: unknown
    unsigned int process     = 0; ///< index of this process

    bool is_ready_for_mpi = true; ///< whether the processes can connect to each other
  };

  Launch
  find_launch();

  /// Whether this process is a direct child of Open MPI's mpirun, not of a script or program that
  /// it has started.
  bool
  is_child_of_mpirun();
} // namespace Exemplar

#endif
