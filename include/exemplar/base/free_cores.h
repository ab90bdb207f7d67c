// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_free_cores_h
#define exemplar_free_cores_h

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// How many threads of this process may work at once: one on each core that it is bound to (by taskset
  /// or mpirun, say), and no more than the quota of its control groups (of a container, say) lets work
  /// without a break; at least one.
  unsigned int
  n_free_cores();

  /// How many cores the quotas of control groups come to, which `mounted` shows (/sys/fs/cgroup) and of
  /// which `membership` names those of a process (/proc/self/cgroup): the least of each group and
  /// those above it. Infinite without a quota.
  double
  cores_of_quotas(const std::filesystem::path &mounted, const std::string &membership);
} // namespace Exemplar

#endif
