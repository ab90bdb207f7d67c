// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_idle_review_h
#define exemplar_idle_review_h

#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

// What a scene has that does nothing. All processes that share the body must call these.

namespace Exemplar
{
  /// Warnings of loads that act on held nodes alone.
  std::vector<std::string>
  idle_load_warnings(const Problem &problem);

  /// For the header of a run, since it may be meant: nothing acts at all, or there are weights by
  /// region where there is one region.
  std::vector<std::string>
  idle_notes(const Problem &problem);
} // namespace Exemplar

#endif
