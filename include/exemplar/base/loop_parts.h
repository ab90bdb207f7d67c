// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loop_parts_h
#define exemplar_loop_parts_h

#include <cstddef>
#include <functional>

namespace Exemplar
{
  /// Call task(i, thread) for i = 0 to n - 1, in this thread, which is number 0, and in up to
  /// n_threads - 1 others of a pool that the process keeps. Each takes one task after the other.
  /// This thread waits for tasks that others have begun, and never for a thread that has begun
  /// none: where other programs occupy the cores, it runs all tasks itself. Tasks may call this
  /// again. If tasks throw, the others are run all the same, and the exception of the first of them
  /// is rethrown here.
  void
  share_tasks(int n, int n_threads, const std::function<void(int i, int thread)> &task);

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
