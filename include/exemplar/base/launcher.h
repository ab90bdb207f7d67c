// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_launcher_h
#define exemplar_launcher_h

#include <string>

namespace Exemplar
{
  /// How mpirun, mpiexec or srun has started this process, by what it has left in the environment.
  struct Launch
  {
    std::string  program;         ///< that has started it; empty if nobody has
    unsigned int n_processes = 1; ///< that it has started together; 0 if it does not say
    unsigned int process     = 0; ///< which of these this is

    bool is_ready_for_mpi = true; ///< whether it tells the processes how they find each other
  };

  Launch
  find_launch();

  /// Whether Open MPI's mpirun itself has started this process, and not a script or program that it has
  /// started.
  bool
  is_child_of_mpirun();
} // namespace Exemplar

#endif
