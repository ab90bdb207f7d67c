// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_free_cores_h
#define exemplar_free_cores_h

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// Number of threads of this process that can run at once: one on each core that it is bound to
  /// (by taskset or mpirun, say), bounded by the quota of its control groups (of a container, say);
  /// at least one.
  unsigned int
  n_free_cores();

  /// Number of cores by the quotas of control groups, mounted at `mounted` (/sys/fs/cgroup): the
  /// least quota of the groups of a process, which `membership` names (/proc/self/cgroup), and of
  /// those above them. Infinite without a quota.
  double
  cores_of_quotas(const std::filesystem::path &mounted, const std::string &membership);
} // namespace Exemplar

#endif
