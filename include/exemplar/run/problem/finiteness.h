// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_finiteness_h
#define exemplar_finiteness_h

#include <exemplar/run/problem/problem.h>

#include <string>

// What a run writes are finite numbers: a state that is none is not accepted.

namespace Exemplar
{
  /// What of a state and of what was found at it is not finite, in words; empty if all is.
  std::string
  what_is_not_finite(const State &state, const Evaluation &evaluation);

  /// The same of what frames show of the cells.
  std::string
  what_is_not_finite(const CellResults &cells);

  /// Throws UserError if a problem's initial state is nothing to begin with. All processes must call this
  /// and the next.
  void
  check_start(Problem &problem);

  /// Make a failure of a report on a problem's step to `next` if that, evaluated, is not finite.
  void
  refuse_what_is_not_finite(Problem &problem, const State &next, SolveReport &report);
} // namespace Exemplar

#endif
