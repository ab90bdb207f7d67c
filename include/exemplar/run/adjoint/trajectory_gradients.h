// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_trajectory_gradients_h
#define exemplar_trajectory_gradients_h

#include <exemplar/run/adjoint/gradients.h>
#include <exemplar/run/problem/problem.h>

#include <deal.II/base/array_view.h>

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// The state at the end of a step, and the step's length [s].
  struct RecordedStep
  {
    double              time, size;
    Vector              positions, velocities;
    std::vector<double> weights;
    std::vector<double> held_tensions; ///< see FibreTensionTerm
    std::vector<double> history;       ///< State::history
    bool                friction_settled = true;
  };

  /// The states of a problem from a first one on, for gradients through its steps.
  class RecordedSteps
  {
  public:
    /// Begins at the problem's state. Throws UserError, by name, for scenes through whose steps
    /// gradients are not known.
    explicit RecordedSteps(const Problem &problem);

    /// Callback for Problem::on_step, of the same problem.
    void
    add(const Problem &problem, const State &start, double size);

    /// Throws UserError, by name, if the steps are not all of one problem, or it was changed since.
    void
    require_one_problem(const Problem &problem) const;

    unsigned int
    size() const
    {
      return steps.size();
    }

    const RecordedStep &
    step(const unsigned int i) const
    {
      return steps[i];
    }

    /// The state before step i; for i = size(), the last state.
    State
    start(unsigned int i) const;

  private:
    /// Positions at the beginning of step i.
    const Vector &
    positions_before(const unsigned int i) const
    {
      return i == 0 ? initial.positions : steps[i - 1].positions;
    }

    const State              initial;
    const bool               has_two_steps; ///< BDF2, which needs two states before a step
    const unsigned int       n_changes;     ///< number of the problem's changes before the steps
    std::deque<RecordedStep> steps;         ///< a deque, so that addresses stay valid
    std::string              broken;        ///< why they are no trajectory; empty if they are
  };

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
    /// Gradients by the tension of each cell in each step; empty without active fibres.
    std::vector<std::vector<double>> tension;
    std::optional<double>            mass_damping, stiffness_damping; ///< in dynamic scenes
    std::optional<Vector>            initial_positions;  ///< in those, and beside friction
    std::optional<Vector>            initial_velocities; ///< in dynamic scenes
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
