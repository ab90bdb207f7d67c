// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_log_h
#define exemplar_step_log_h

#include <exemplar/run/problem/problem.h>

namespace Exemplar::Python
{
  /// Report a step to logging.getLogger("exemplar"), at level INFO. Costs nothing unless Python has
  /// imported logging. The caller holds Python's lock.
  void
  log_step(const Problem &problem, const SolveReport &report);
} // namespace Exemplar::Python

#endif
