// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_recorded_steps_h
#define exemplar_recorded_steps_h

#include <exemplar/run/problem/problem.h>

#include <deque>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The state at the end of a step, and the step's length [s].
  struct RecordedStep
  {
    double              time, size;
    Vector              positions, velocities;
    std::vector<double> weights;
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
} // namespace Exemplar

#endif
