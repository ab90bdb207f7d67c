// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_starts_h
#define exemplar_example_starts_h

#include <exemplar/run/problem/problem.h>

#include <optional>

// A body with examples has an equilibrium near each of them, and steps find that which the way leads to. Here
// others are looked for, from the examples themselves.

namespace Exemplar
{
  /// Of a static scene that stands at its end, the example that has least energy, and clearly less than
  /// the state, where it is placed with the held nodes at their places and the best weights; none if there
  /// is no such. One evaluation an example. All processes must call this.
  std::optional<ExampleStart>
  missed_example(Problem &problem);

  /// With Solver/Starts = examples, `end` becomes the equilibrium of least energy of those found from the
  /// examples and itself; all are kept in the problem's Examples. All processes must call this.
  void
  start_from_examples(Problem            &problem,
                      State              &end,
                      const StepInterval &interval,
                      SolveReport        &report);
} // namespace Exemplar

#endif
