// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_idle_review_h
#define exemplar_idle_review_h

#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

// Checks for parts of a scene that have no effect. All processes that share the body must call
// these.

namespace Exemplar
{
  /// Warnings of loads that act on held nodes alone.
  std::vector<std::string>
  idle_load_warnings(const Problem &problem);

  /// Notes for the header of a run, as it may be intended: nothing acts at all, or weights are by
  /// region but there is one region.
  std::vector<std::string>
  idle_notes(const Problem &problem);
} // namespace Exemplar

#endif
