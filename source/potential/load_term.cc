// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/load_term.h>

#include <cmath>

namespace Exemplar
{
  LoadTerm::LoadTerm(const Loads &loads, const Vector &rest_positions)
      : loads(loads), rest_positions(rest_positions)
  {
  }

  void
  LoadTerm::set_time(const double time)
  {
    force.reinit(rest_positions.size());
    if (loads.has_named_loads())
      loads.named_loads(time, force);
    if (loads.has_gravity())
      force.add(loads.ramp_factor(time), loads.gravity());
    force_norms.reinit(force.size() / 3);
    for (unsigned int node = 0; node < force_norms.size(); ++node)
      force_norms[node] = std::hypot(force[3 * node], force[3 * node + 1], force[3 * node + 2]);
  }

  bool
  LoadTerm::differs(const double time, const double other_time) const
  {
    if (loads.has_gravity() && loads.ramp_factor(time) != loads.ramp_factor(other_time))
      return true;
    Vector here(rest_positions.size()), there(rest_positions.size());
    loads.named_loads(time, here);
    loads.named_loads(other_time, there);
    return exchange->any(here != there);
  }

  void
  LoadTerm::attach(const SymmetricPattern & /*pattern*/, const FreeDofs &free_dofs)
  {
    exchange = &free_dofs.exchange();
  }

  double
  LoadTerm::add(const Vector &positions, Vector &gradient, Vector &force_scale) const
  {
    gradient -= force;
    force_scale += force_norms;
    Vector displacement = positions;
    displacement -= rest_positions;
    return -exchange->product(force, displacement);
  }

  std::size_t
  LoadTerm::memory_consumption() const
  {
    return force.memory_consumption() + force_norms.memory_consumption();
  }
} // namespace Exemplar
