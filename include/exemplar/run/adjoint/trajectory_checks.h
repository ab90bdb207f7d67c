// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_trajectory_checks_h
#define exemplar_trajectory_checks_h

#include <exemplar/run/problem/problem.h>

// Preconditions of trajectory_gradients().

namespace Exemplar
{
  /// Throws UserError, by name, for scenes that gradients through steps do not know.
  void
  require_known_steps(const Problem &problem);

  /// The residual tolerance of the steps.
  double
  required_residual(const SolverParameters &solver);

  /// Throws UserError if the state does not solve the equations of `step`, counted from 0, to the
  /// scene's tolerance, which for quasi-Newton steps is Solver/Step tolerance.
  void
  require_solved_step(const Problem &problem, const Evaluation &evaluation, unsigned int step);
} // namespace Exemplar

#endif
