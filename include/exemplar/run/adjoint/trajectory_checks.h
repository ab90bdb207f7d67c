// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_trajectory_checks_h
#define exemplar_trajectory_checks_h

#include <exemplar/run/problem/problem.h>

// What trajectory_gradients() relies on.

namespace Exemplar
{
  /// Throws UserError, by name, for what the scene has and gradients through steps do not know.
  void
  require_known_steps(const Problem &problem);

  /// The residual to which steps are solved.
  double
  required_residual(const SolverParameters &solver);

  /// Throws UserError for a state that is not where a step, counted from 0, ends that was solved as the
  /// scene says. Steps of quasi-Newton's method are solved to Solver/Step tolerance.
  void
  require_solved_step(const Problem &problem, const Evaluation &evaluation, unsigned int step);
} // namespace Exemplar

#endif
