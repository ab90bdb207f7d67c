// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loop_parts_h
#define exemplar_loop_parts_h

#include <exemplar/base/thread_team.h>

#include <cstddef>
#include <functional>

namespace Exemplar
{
  /// Call function(i, thread) for tasks 0 to n - 1 of possibly very different durations, in up to
  /// n_threads threads, as share_tasks() does. With one thread it stops at the first task that
  /// throws.
  template <typename Function>
  void
  for_each_task(const int n, const int n_threads, const Function &function)
  {
    if (n_threads > 1 && n > 1)
      share_tasks(n, n_threads, std::cref(function));
    else
      for (int i = 0; i < n; ++i)
        function(i, 0);
  }

  /// Call function(part, begin, end) for n_parts consecutive parts of the numbers 0 to n - 1, in up
  /// to n_threads threads.
  template <typename Function>
  void
  for_each_part(const std::size_t n_parts,
                const std::size_t n,
                const int         n_threads,
                const Function   &function)
  {
    for_each_task(static_cast<int>(n_parts), n_threads,
                  [&](const std::size_t part, int /*thread*/)
                  { function(part, part * n / n_parts, (part + 1) * n / n_parts); });
  }
} // namespace Exemplar

#endif
