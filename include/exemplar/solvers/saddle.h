// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_saddle_h
#define exemplar_saddle_h

#include <exemplar/solvers/step_system.h>

namespace Exemplar
{
  /// A displacement v of free degrees of freedom along which the potential curves downwards,
  /// v.K v < 0, where its exact tangent K is indefinite; its greatest component is 1 m. Empty if
  /// none is found. `system` holds a factor of A, a definite mixture of K and the convex tangent.
  ///
  /// Power iterations with a I - A^-1 K amplify what has the least ratio v.K v / v.A v; they begin
  /// with a vector that is the same every time. K v are differences of gradients. Throws
  /// SolverFailure as StepSystem::solve().
  Vector
  downward_curvature(StepSystem           &system,
                     IncrementalPotential &potential,
                     const State          &at);
} // namespace Exemplar

#endif
