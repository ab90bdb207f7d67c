// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/quasi_newton.h>

#include <boost/serialization/deque.hpp>
#include <boost/serialization/vector.hpp>
#include <deal.II/base/memory_consumption.h>

// What the quasi-Newton method remembers from step to step, for checkpoints.

namespace Exemplar
{
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
    const FreeDofs &free_dofs  = potential.get_free_dofs();
    MetricHistory   of_body    = history;
    Lbfgs           body_lbfgs = lbfgs;
    of_body.positions          = whole(free_dofs.exchange(), history.positions);
    for (Vector *field : of_body.start.nodal_fields())
      *field = whole(free_dofs.exchange(), *field);
    of_body.start.history = potential.cell_order().whole(history.start.history);
    body_lbfgs.map([&](const std::vector<double> &vector) { return free_dofs.whole(vector); });
    archive &of_body &next &body_lbfgs; // several processes have no next one
    prediction.save(archive);
  }

  void
  QuasiNewton::load(boost::archive::binary_iarchive &archive)
  {
    const FreeDofs         &free_dofs = potential.get_free_dofs();
    archive &history &next &lbfgs;
    history.positions = part(free_dofs.exchange(), history.positions);
    for (Vector *field : history.start.nodal_fields())
      *field = part(free_dofs.exchange(), *field);
    history.start.history = potential.cell_order().part(history.start.history);
    lbfgs.map([&](const std::vector<double> &vector) { return free_dofs.part(vector); });
    prediction.load(archive);
    metric.clear();
  }

  std::size_t
  QuasiNewton::memory_consumption() const
  {
    if (metric.empty())
      return 0;
    return metric.memory_consumption() + history.positions.memory_consumption()
           + lbfgs.memory_consumption() + prediction.memory_consumption()
           + dealii::MemoryConsumption::memory_consumption(node_rotations);
  }
} // namespace Exemplar
