// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_gradients_h
#define exemplar_gradients_h

#include <exemplar/run/adjoint/slope_derivatives.h>

#include <optional>

namespace Exemplar
{
  /// The gradient by an obstacle.
  struct ObstacleGradients
  {
    std::string name;
    std::optional<SpaceVector3>
                          displacement; ///< at all times; none where the obstacle was set back
    std::optional<double> radius;       ///< of spheres and capsules that were not set back
    std::optional<double> friction;     ///< if it is positive
  };

  /// The gradient of a function J(x, w) of the positions and weights of a static equilibrium by the
  /// data that the equilibrium depends on; doc/gradients.md.
  struct Gradients
  {
    std::optional<std::vector<double>> young, poisson; ///< by cell; not if orthotropic
    std::vector<double>                density;        ///< by cell
    std::optional<std::vector<double>> thickness;      ///< by triangle of a shell; none for solids
    std::optional<std::vector<double>> tension;        ///< by cell; none without active fibres
    std::optional<double>              importance;     ///< none without examples
    std::vector<Vector>                poses;          ///< of all examples but the rest pose
    std::optional<Vector> rest_positions; ///< none if blended regions depend on them, or obstacles
    Vector                handles;        ///< zero at free nodes
    Vector                nodal_forces;
    std::array<double, 3> gravity{};
    std::vector<ObstacleGradients> obstacles;     ///< in the order of Obstacles/Names
    std::vector<unsigned int>      weakly_active; ///< weights at which the gradient is one-sided
  };

  /// Gradients at the problem's state. `by_state` is dJ/dx by degree of freedom and dJ/dw by
  /// weight. Throws UserError for scenes that it does not know and states that are no equilibrium,
  /// and SolverFailure if the exact tangent is not positive definite. The problem stays as it is.
  Gradients
  gradients(Problem &problem, const Direction &by_state);

  /// The gradients except those by handles, from the derivatives of a slope.
  Gradients
  gradients_of(const Problem &problem, SlopeDerivatives slope);

  /// Gradient by prescribed positions: dJ/dx - (Phi_xx a + Phi_xw b) at held degrees of freedom,
  /// else zero.
  Vector
  of_held(const Problem &problem, Vector by_state, const Vector &slope_by_positions);

  /// Message of the SolverFailure if derivatives overflow.
  constexpr const char *too_large
      = "The derivatives of J lead to numbers that are too large to be held. Scale J.";

  /// Throws SolverFailure if a gradient, or the sum of others that belong to it, is not finite.
  void
  require_finite(const Gradients &found, double sum_of_others = 0.);

  /// Weights at the problem's state at which gradients are one-sided.
  std::vector<unsigned int>
  weakly_active(const Problem &problem, const Evaluation &evaluation);
} // namespace Exemplar

#endif
