// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/free_cores.h>
#include <exemplar/base/text_file.h>

#include <algorithm>
#include <limits>
#include <sched.h>
#include <sstream>
#include <thread>
#include <vector>

namespace Exemplar
{
  namespace
  {
    namespace fs = std::filesystem;

    constexpr double no_quota = std::numeric_limits<double>::infinity();

    /// Number of cores from a text of quota and period in microseconds; a group without a quota has
    /// "max" or -1.
    double
    cores_of(const std::string &quota_and_period)
    {
      std::istringstream text(quota_and_period);
      double             quota = 0., period = 0.;
      return text >> quota >> period && quota > 0. && period > 0. ? quota / period : no_quota;
    }

    /// The quota of a group, which stands in one file (version 2) or in two (version 1).
    double
    quota_of(const fs::path &group)
    {
      if (const auto text = read_text_file(group / "cpu.max"))
        return cores_of(*text);
      return cores_of(read_text_file(group / "cpu.cfs_quota_us").value_or("") + " "
                      + read_text_file(group / "cpu.cfs_period_us").value_or(""));
    }

    /// Least quota of a group and those above it up to the mount point. A container may see its own
    /// group only there, whatever path it is given.
    double
    least_quota(const fs::path &mounted, const fs::path &path)
    {
      double   least = quota_of(mounted);
      fs::path group = mounted;
      for (const fs::path &name : path.relative_path())
        least = std::min(least, quota_of(group /= name));
      return least;
    }

    /// Whether these controllers, from a line of /proc/self/cgroup, include that of processor time
    /// in version 1.
    bool
    has_processors(const std::string &controllers)
    {
      std::istringstream list(controllers);
      for (std::string name; std::getline(list, name, ',');)
        if (name == "cpu")
          return true;
      return false;
    }

    unsigned int
    n_bound_cores()
    {
      // the kernel rejects a set that is too small for the cores of the machine
      for (std::size_t n = CPU_SETSIZE; n <= (1U << 20); n *= 2)
      {
        std::vector<cpu_set_t> set(n / CPU_SETSIZE);
        const std::size_t      bytes = set.size() * sizeof(cpu_set_t);
        if (sched_getaffinity(0, bytes, set.data()) == 0)
          return static_cast<unsigned int>(CPU_COUNT_S(bytes, set.data()));
      }
      return std::thread::hardware_concurrency();
    }
  } // namespace

  double
  cores_of_quotas(const fs::path &mounted, const std::string &membership)
  {
    double             least = no_quota;
    std::istringstream lines(membership);
    for (std::string number, controllers, path; std::getline(lines, number, ':')
                                                && std::getline(lines, controllers, ':')
                                                && std::getline(lines, path);)
      if (controllers.empty()) // version 2, where all is in one hierarchy
        least = std::min(least, least_quota(mounted, path));
      else if (has_processors(controllers))
        least = std::min(least, least_quota(mounted / "cpu", path));
    return least;
  }

  unsigned int
  n_free_cores()
  {
    const double n = std::min<double>(
        n_bound_cores(),
        cores_of_quotas("/sys/fs/cgroup", read_text_file("/proc/self/cgroup").value_or("")));
    return std::max(1U, static_cast<unsigned int>(n));
  }
} // namespace Exemplar
