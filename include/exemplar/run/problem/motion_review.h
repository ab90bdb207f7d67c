// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_motion_review_h
#define exemplar_motion_review_h

#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Warnings of handles whose displacements look like positions, that jump at the start of a
  /// dynamic scene, or that move implausibly far. `is_resumed`: the run does not begin at the
  /// scene's start. All processes that share the body must call this.
  std::vector<std::string>
  motion_warnings(const Problem &problem, bool is_resumed = false);

  /// motion_warnings() for the handles in the next step alone, whose motions a program has set.
  /// Throws as Handles::move().
  std::vector<std::string>
  next_step_warnings(const Problem &problem);

  /// Whether a handle is displaced at any time, or its motion is not finite. All processes that
  /// share the body must call this.
  bool
  is_any_handle_moved(const Problem &problem);
} // namespace Exemplar

#endif
