// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_trajectory_gradients_h
#define exemplar_trajectory_gradients_h

#include <exemplar/run/adjoint/gradients.h>
#include <exemplar/run/adjoint/recorded_steps.h>

#include <deal.II/base/array_view.h>

#include <optional>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Derivatives of a function J by the state at the end of a step; empty: zero.
  struct StateDerivatives
  {
    dealii::ArrayView<const double> positions, weights, velocities;
  };

  /// The gradient of a function J of the states at the ends of steps, by what all steps depend on;
  /// doc/gradients.md.
  struct TrajectoryGradients
  {
    /// By what holds for all steps; handles by a displacement that is the same in all. No list of weak
    /// weights.
    Gradients all;
    /// By the positions of held nodes at the end of each step, three numbers a node, in that order.
    std::vector<std::vector<double>> handles;
    std::vector<unsigned int>        held_nodes;
    std::optional<double> mass_damping, stiffness_damping; ///< in dynamic scenes, as what follows
    std::optional<Vector> initial_positions, initial_velocities;
    /// As Gradients::weakly_active, with the step counted from 0.
    std::vector<std::pair<unsigned int, unsigned int>> weakly_active;
  };

  /// Of J that has these derivatives, as many as there are steps, one tangent factorised a step. Throws
  /// UserError for steps that it does not know and for those that were not solved, and SolverFailure if
  /// an exact tangent is not positive definite. The problem stays as it is.
  TrajectoryGradients
  trajectory_gradients(Problem                             &problem,
                       const RecordedSteps                 &steps,
                       const std::vector<StateDerivatives> &by_states);
} // namespace Exemplar

#endif
