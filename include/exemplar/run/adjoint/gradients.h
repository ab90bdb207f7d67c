// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_gradients_h
#define exemplar_gradients_h

#include <exemplar/run/adjoint/slope_derivatives.h>

#include <optional>

namespace Exemplar
{
  /// The gradient of a function J(x, w) of the positions and weights of a static equilibrium, by what the
  /// equilibrium depends on; doc/gradients.md.
  struct Gradients
  {
    std::optional<std::vector<double>> young, poisson; ///< by cell; unless some cell is orthotropic
    std::vector<double>                density;        ///< by cell
    std::optional<double>              importance;     ///< with examples
    std::vector<Vector>                poses;          ///< of all examples but the rest pose
    std::optional<Vector>              rest_positions; ///< unless shares of regions follow them
    Vector                             handles;        ///< zero where nothing is held
    Vector                             nodal_forces;
    std::array<double, 3>              gravity{};
    std::vector<unsigned int> weakly_active; ///< weights at which the gradient is one-sided
  };

  /// Of the state where the problem stands. `by_state` is dJ/dx by degree of freedom and dJ/dw by weight.
  /// Throws UserError for scenes that it does not know and states that are no equilibrium, and
  /// SolverFailure if the exact tangent is not positive definite. The problem stays as it is.
  Gradients
  gradients(Problem &problem, const Direction &by_state);

  /// The gradients by all but handles, from the derivatives of a slope.
  Gradients
  gradients_of(const Problem &problem, SlopeDerivatives slope);

  /// dJ/dx less Phi_xx a + Phi_xw b where something is held, and zero elsewhere.
  Vector
  of_held(const Problem &problem, Vector by_state, const Vector &slope_by_positions);

  /// What a SolverFailure says where derivatives are beyond what numbers hold.
  constexpr const char *too_large
      = "The derivatives of J lead to numbers that are too large to be held. Scale J.";

  /// Throws SolverFailure if one is not finite, or this sum of others that go with them.
  void
  require_finite(const Gradients &found, double sum_of_others = 0.);

  /// Weights at the problem's state at which gradients are one-sided.
  std::vector<unsigned int>
  weakly_active(const Problem &problem, const Evaluation &evaluation);
} // namespace Exemplar

#endif
