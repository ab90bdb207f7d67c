// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_solve_h
#define exemplar_adjoint_solve_h

#include <exemplar/run/adjoint/adjoint_system.h>

#include <functional>

namespace Exemplar
{
  /// The direction (a, b) with Phi'' (a, b) = (dJ/dx, dJ/dw) on the free degrees of freedom and the weights
  /// that are at no bound, whose changes keep the sums of each region; zero elsewhere. It is solved by a
  /// factor of the exact tangent at the state and corrected with the exact derivatives. Throws SolverFailure
  /// if the tangent is not positive definite, or the correction does not converge.
  struct AdjointSolution
  {
    Direction        direction;
    SlopeDerivatives derivatives; ///< of the slope along it
  };

  /// All derivatives of the slope along a direction.
  using FindDerivatives = std::function<SlopeDerivatives(const Direction &)>;

  /// At the state to which the system went last. `find` is called with the direction of the solution last.
  AdjointSolution
  solve_adjoint(AdjointSystem &system, const Direction &by_state, const FindDerivatives &find);

  /// At the state of a static problem, where its potential has this evaluation.
  AdjointSolution
  solve_adjoint(Problem &problem, const Evaluation &evaluation, const Direction &by_state);

  /// Whether steps find this weight and neither a bound holds it nor what it remembers.
  std::vector<bool>
  are_inactive(const Problem &problem);
} // namespace Exemplar

#endif
