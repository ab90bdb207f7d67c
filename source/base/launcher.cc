// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/launcher.h>

#include <fmt/core.h>

#include <cstdlib>
#include <fstream>
#include <unistd.h>

namespace Exemplar
{
  namespace
  {
    /// A number in the environment, or `otherwise`.
    unsigned int
    number_in_environment(const char *name, const unsigned int otherwise)
    {
      const char *text = std::getenv(name);
      if (text == nullptr)
        return otherwise;
      char               *end    = nullptr;
      const unsigned long number = std::strtoul(text, &end, 10);
      return end == text || *end != '\0' ? otherwise : static_cast<unsigned int>(number);
    }

    bool
    is_in_environment(const char *name)
    {
      return std::getenv(name) != nullptr;
    }
  } // namespace

  Launch
  find_launch()
  {
    // innermost launcher first: mpirun may itself use srun, and run in a job of Slurm
    if (is_in_environment("OMPI_COMM_WORLD_SIZE")) // Open MPI's mpirun
      return { "mpirun", number_in_environment("OMPI_COMM_WORLD_SIZE", 0),
               number_in_environment("OMPI_COMM_WORLD_RANK", 0) };
    const unsigned int n_tasks = number_in_environment("SLURM_STEP_NUM_TASKS", 0);
    if (is_in_environment("PMI_SIZE")) // MPICH's mpiexec; srun --mpi=pmi2
      return { n_tasks > 0 ? "srun" : "mpiexec", number_in_environment("PMI_SIZE", 0),
               number_in_environment("PMI_RANK", 0) };
    if (is_in_environment("PMIX_RANK")) // srun --mpi=pmix
      return { n_tasks > 0 ? "srun" : "mpirun", n_tasks, number_in_environment("PMIX_RANK", 0) };
    // a shell of srun --pty is one process, however many tasks its step has
    if (n_tasks > 1 && !is_in_environment("SLURM_PTY_PORT"))
      return { "srun", n_tasks, number_in_environment("SLURM_PROCID", 0), false };
    return {};
  }

  bool
  is_child_of_mpirun()
  {
    if (!is_in_environment("OMPI_COMM_WORLD_SIZE"))
      return false;
    std::ifstream comm(fmt::format("/proc/{}/comm", getppid()));
    std::string   parent;
    std::getline(comm, parent);
    for (const std::string name : { "mpirun", "mpiexec", "orte" }) // orterun, orted, mpirun.openmpi
      if (parent.compare(0, name.size(), name) == 0)
        return true;
    return false;
  }
} // namespace Exemplar
