// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_finiteness_h
#define exemplar_finiteness_h

#include <exemplar/run/frames/frame_writer.h>
#include <exemplar/run/problem/problem.h>

#include <string>

// Checks for NaN and infinity: a state with such numbers is not accepted.

namespace Exemplar
{
  /// Names of the quantities at a state that are not finite; empty if all are.
  std::string
  what_is_not_finite(const State &state, const Evaluation &evaluation);

  /// Names of the cell results in frames that are not finite; empty if all are.
  std::string
  what_is_not_finite(const CellResults &cells);

  /// Names of what a frame holds that is not finite; empty if all is.
  std::string
  what_is_not_finite(const Frame &frame);

  /// Throws UserError if quantities at the initial state are not finite. All processes must call
  /// this and the next.
  void
  check_start(Problem &problem);

  /// Turn a report on a problem's step to `next` into a failure if quantities at `next`, as
  /// evaluated, are not finite.
  void
  refuse_what_is_not_finite(Problem &problem, const State &next, SolveReport &report);
} // namespace Exemplar

#endif
