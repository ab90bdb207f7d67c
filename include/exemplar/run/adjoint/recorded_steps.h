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

  /// The states of a problem from one of them on, for gradients through its steps.
  class RecordedSteps
  {
  public:
    /// Begins where the problem stands. Throws UserError, by name, for scenes through whose steps no
    /// gradients are known.
    explicit RecordedSteps(const Problem &problem);

    /// For Problem::on_step, of the same problem.
    void
    add(const Problem &problem, const State &start, double size);

    /// Throws UserError, by name, where the steps are not all of one problem, which this still is.
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

    /// The state from which step i was made; that from which none was for i = size().
    State
    start(unsigned int i) const;

  private:
    /// Where step i begins.
    const Vector &
    positions_before(const unsigned int i) const
    {
      return i == 0 ? initial.positions : steps[i - 1].positions;
    }

    const State              initial;
    const bool               has_two_steps; ///< the time scheme, which looks at two states
    const unsigned int       n_changes;     ///< of the problem, before
    std::deque<RecordedStep> steps;         ///< which stay where they are in memory
    std::string              broken;        ///< why they are no path; empty: they are
  };
} // namespace Exemplar

#endif
