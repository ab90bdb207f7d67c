// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_thread_team_h
#define exemplar_thread_team_h

#include <functional>

namespace Exemplar
{
  /// Call task(i, thread) for i = 0 to n - 1, in this thread, which is number 0, and in up to
  /// n_threads - 1 others, which the process keeps for all such calls. Each takes one task after the
  /// other. This thread waits for tasks that others have begun, and never for a thread that has begun
  /// none: where other programs have the cores, it does all tasks itself. Tasks may share tasks
  /// again. If tasks throw, the others are done all the same, and what the first of them has thrown
  /// is thrown here.
  void
  share_tasks(int n, int n_threads, const std::function<void(int i, int thread)> &task);
} // namespace Exemplar

#endif
