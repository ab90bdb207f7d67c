// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/quasi_newton.h>

// The metric that a thread makes while steps go on with the last one, and metrics of before a resume.

namespace Exemplar
{
  namespace
  {
    /// As many iterations of the cost of a metric count as one step: few, so that its thread is done by then. One
    /// step earlier or two later changes the number of iterations by a fiftieth.
    constexpr double iterations_of_a_step = 2.;
  } // namespace

  bool
  QuasiNewton::is_next_due() const
  {
    return next.positions.size() > 0
           && next.steps * iterations_of_a_step >= metric.cost_in_iterations();
  }

  bool
  QuasiNewton::begin_next_metric(const State &start, const double step_size, const State &trial)
  {
    if (!parameters.background_factor)
      return false;
    if (next.positions.size() > 0)
      return true; // it is on its way
    if (!begin_factor(trial.positions, trial.weights))
      return false;
    next = new_history(start, step_size, trial);
    return true;
  }

  bool
  QuasiNewton::begin_factor(const Vector &positions, const std::vector<double> &weights)
  {
    potential.get_body().node_rotations(next_rotations);
    return system.begin_metric(positions, weights);
  }

  void
  QuasiNewton::take_next_metric()
  {
    const std::vector<double> columns = system.take_factor();
    metric.reinit(system.bordered(), columns, next_rotations);
    history       = next;
    history.steps = 0;
    next          = {};
    lbfgs.clear();
  }

  void
  QuasiNewton::rebuild_metrics(const State &accepted, const double step_size, const double time)
  {
    if (history.positions.size() == 0 || !metric.empty()
        || history.mass_factor != potential.mass_factor())
      return;
    const auto go_back_to = [&](const MetricHistory &made)
    {
      if (made.start.positions.size() > 0)
        potential.begin_step(made.start, made.step_size);
      potential.set_time_of_terms(made.time);
      potential.get_body().update_rotations(made.positions);
    };
    go_back_to(history);
    make_metric(history.positions, history.weights);
    system.count_as_remade();
    if (next.positions.size() > 0 && next.mass_factor == potential.mass_factor())
    {
      go_back_to(next);
      begin_factor(next.positions, next.weights);
    }
    if (history.start.positions.size() > 0)
      potential.begin_step(accepted, step_size);
    potential.set_time_of_terms(time);
  }
} // namespace Exemplar
