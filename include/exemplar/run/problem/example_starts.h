// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_starts_h
#define exemplar_example_starts_h

#include <exemplar/run/problem/problem.h>

#include <optional>

// A body with examples has an equilibrium near each of them, and steps find one that depends on the
// path. These functions search for others from the examples.

namespace Exemplar
{
  /// At the end of a static scene: the example with the least energy, evaluated with the held nodes
  /// in place and the best weights, if that is clearly less than the state's; else nothing. One
  /// evaluation an example. All processes must call this.
  std::optional<ExampleStart>
  missed_example(Problem &problem);

  /// With Solver/Starts = examples, replace `end` by the equilibrium of least energy among itself
  /// and those found from the examples; all are recorded in the problem's Examples. All processes
  /// must call this.
  void
  start_from_examples(Problem            &problem,
                      State              &end,
                      const StepInterval &interval,
                      SolveReport        &report);
} // namespace Exemplar

#endif
