// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_thread_team_h
#define exemplar_thread_team_h

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
} // namespace Exemplar

#endif
