// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_solve_h
#define exemplar_adjoint_solve_h

#include <exemplar/run/adjoint/adjoint_system.h>

#include <functional>

namespace Exemplar
{
  /// The direction (a, b) with Phi'' (a, b) = (dJ/dx, dJ/dw) on the free degrees of freedom and on
  /// the weights at no bound, whose changes sum to zero in each region; (a, b) is zero elsewhere.
  /// Solved with a factor of the exact tangent at the state, then corrected with the exact
  /// derivatives. Throws SolverFailure if the tangent is not positive definite, or the correction
  /// does not converge.
  struct AdjointSolution
  {
    Direction        direction;
    SlopeDerivatives derivatives; ///< derivatives of the slope along `direction`
  };

  /// All derivatives of the slope along a direction.
  using FindDerivatives = std::function<SlopeDerivatives(const Direction &)>;

  /// Adjoint solution at the state of the system's last go_to_state(). The last call of `find` has
  /// the solution's direction.
  AdjointSolution
  solve_adjoint(AdjointSystem &system, const Direction &by_state, const FindDerivatives &find);

  /// Adjoint solution at the state of a static problem, where its potential has this evaluation.
  AdjointSolution
  solve_adjoint(Problem &problem, const Evaluation &evaluation, const Direction &by_state);

  /// Whether each weight is an unknown that neither a bound nor its memory (yield) holds in place.
  std::vector<bool>
  are_inactive(const Problem &problem);
} // namespace Exemplar

#endif
