// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/quasi_newton.h>

#include <boost/serialization/vector.hpp>
#include <deal.II/base/memory_consumption.h>

// The metric that a thread makes while steps go on with the last one, metrics of before a resume, and what the method
// remembers from step to step.

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
    return next.made != nullptr && next.steps * iterations_of_a_step >= metric.cost_in_iterations();
  }

  bool
  QuasiNewton::begin_next_metric(const State &start, const double step_size, const State &trial)
  {
    if (!parameters.background_factor)
      return false;
    if (next.made)
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
    if (!history.made || !metric.empty() || history.mass_factor() != potential.mass_factor())
      return;
    const auto go_back_to = [&](const MetricOrigin &made)
    {
      if (made.start.positions.size() > 0)
        potential.begin_step(made.start, made.step_size);
      potential.set_time_of_terms(made.time);
      potential.get_body().update_rotations(made.positions);
    };
    go_back_to(*history.made);
    make_metric(history.made->positions, history.made->weights);
    system.count_as_remade();
    if (next.made && next.mass_factor() == potential.mass_factor())
    {
      go_back_to(*next.made);
      begin_factor(next.made->positions, next.made->weights);
    }
    if (history.made->start.positions.size() > 0)
      potential.begin_step(accepted, step_size);
    potential.set_time_of_terms(time);
  }

  void
  QuasiNewton::keep()
  {
    lbfgs.keep();
    kept = { history, next };
  }

  void
  QuasiNewton::go_back()
  {
    prediction.take_back();
    lbfgs.go_back();
    history = kept.history;
    next    = kept.next;
    contact.forget();
    metric.clear(); // made again when it is needed, as after a resume
  }

  void
  QuasiNewton::forget()
  {
    newton.forget();
    prediction.forget();
    lbfgs.clear();
    metric.clear();
    history = {};
    next    = {};
  }

  void
  QuasiNewton::save(boost::archive::binary_oarchive &archive) const
  {
    const FreeDofs &free_dofs = potential.get_free_dofs();
    MetricHistory   of_body = history, next_of_body = next; // several processes have no next one
    Lbfgs           body_lbfgs = lbfgs;
    MetricOrigin    origin     = history.made ? *history.made : MetricOrigin();
    origin.positions           = whole(free_dofs.exchange(), origin.positions);
    for (Vector *field : origin.start.nodal_fields())
      *field = whole(free_dofs.exchange(), *field);
    origin.start.history = potential.get_body().history_order().whole(origin.start.history);
    of_body.made         = std::make_shared<const MetricOrigin>(std::move(origin));
    body_lbfgs.map([&](const std::vector<double> &vector) { return free_dofs.whole(vector); });
    archive &of_body &next_of_body &body_lbfgs;
    prediction.save(archive);
  }

  void
  QuasiNewton::load(boost::archive::binary_iarchive &archive)
  {
    const FreeDofs         &free_dofs = potential.get_free_dofs();
    archive &history &next &lbfgs;
    if (history.made)
    {
      MetricOrigin origin = *history.made;
      origin.positions    = part(free_dofs.exchange(), origin.positions);
      for (Vector *field : origin.start.nodal_fields())
        *field = part(free_dofs.exchange(), *field);
      origin.start.history = potential.get_body().history_order().part(origin.start.history);
      history.made         = std::make_shared<const MetricOrigin>(std::move(origin));
    }
    lbfgs.map([&](const std::vector<double> &vector) { return free_dofs.part(vector); });
    prediction.load(archive);
    metric.clear();
  }

  std::size_t
  QuasiNewton::memory_consumption() const
  {
    if (metric.empty())
      return 0;
    using dealii::MemoryConsumption::memory_consumption;
    const Iteration &iteration = memory.iteration;
    return metric.memory_consumption() + contact.memory_consumption()
           + (history.made ? history.made->positions.memory_consumption() : 0)
           + lbfgs.memory_consumption() + prediction.memory_consumption()
           + memory_consumption(node_rotations) + memory_consumption(memory.node_rotations)
           + memory_consumption(iteration.gradient) + memory_consumption(iteration.direct)
           + memory_consumption(iteration.rotated) + memory_consumption(memory.old_gradient)
           + memory.displacement.memory_consumption() + memory.trial.positions.memory_consumption()
           + memory.trial.velocities.memory_consumption();
  }
} // namespace Exemplar
