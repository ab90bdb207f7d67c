// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_motion_review_h
#define exemplar_motion_review_h

#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Warnings of handles that seem to be given places instead of displacements, that jump where a
  /// dynamic scene begins, or that move further than can be meant. `is_resumed`: the run begins
  /// elsewhere. All processes that share the body must call this.
  std::vector<std::string>
  motion_warnings(const Problem &problem, bool is_resumed = false);

  /// The same of the handles in the next step alone: for motions that a program has set. Throws what
  /// Handles::move() throws.
  std::vector<std::string>
  next_step_warnings(const Problem &problem);

  /// Whether a handle leaves its rest at any time, or its motion is not finite. All processes that
  /// share the body must call this.
  bool
  is_any_handle_moved(const Problem &problem);
} // namespace Exemplar

#endif
