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

  /// The gradient of a function J of the states at the ends of steps, by the data that all steps
  /// share; doc/gradients.md.
  struct TrajectoryGradients
  {
    /// Gradients by data constant in time; handles by a displacement that is constant in time. Its
    /// weakly_active is empty.
    Gradients all;
    /// Gradients by the positions of held nodes at the end of each step, three components a node,
    /// in the order of held_nodes.
    std::vector<std::vector<double>> handles;
    std::vector<unsigned int>        held_nodes;
    std::optional<double> mass_damping, stiffness_damping; ///< in dynamic scenes, like the next two
    std::optional<Vector> initial_positions, initial_velocities;
    /// Pairs of a step, counted from 0, and a weight as in Gradients::weakly_active.
    std::vector<std::pair<unsigned int, unsigned int>> weakly_active;
  };

  /// Gradients of a J with these derivatives, one entry a step; one tangent is factorised a step.
  /// Throws UserError for steps whose gradients are not known or that were not solved, and
  /// SolverFailure if an exact tangent is not positive definite. The problem stays as it is.
  TrajectoryGradients
  trajectory_gradients(Problem                             &problem,
                       const RecordedSteps                 &steps,
                       const std::vector<StateDerivatives> &by_states);
} // namespace Exemplar

#endif
