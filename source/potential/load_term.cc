// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/load_term.h>

#include <cmath>

namespace Exemplar
{
  void
  LoadTerm::find_forces(const double time, Vector &forces) const
  {
    forces.reinit(fe_space.n_dofs());
    if (loads.has_named_loads())
      loads.named_loads(time, forces);
    if (loads.has_gravity())
      forces.add(loads.ramp_factor(time), loads.gravity());
    fe_space.exchange().keep_owned(forces);
  }

  void
  LoadTerm::set_time(const double time)
  {
    find_forces(time, force);
    force_norms.reinit(fe_space.n_nodes());
    for (unsigned int node = 0; node < force_norms.size(); ++node)
      force_norms[node] = std::hypot(force[3 * node], force[3 * node + 1], force[3 * node + 2]);
  }

  bool
  LoadTerm::differs(const double time, const double other_time) const
  {
    if (loads.has_gravity() && loads.ramp_factor(time) != loads.ramp_factor(other_time))
      return true;
    Vector here(fe_space.n_dofs()), there(fe_space.n_dofs());
    loads.named_loads(time, here);
    loads.named_loads(other_time, there);
    return here != there;
  }

  std::optional<EnergyFlow>
  LoadTerm::energy_flow(const State &start, const State &end) const
  {
    find_forces(start.time, force_at_start);
    double by_start = 0., by_end = 0.;
    for (unsigned int dof = 0; dof < force.size(); ++dof)
    {
      const double way = end.positions[dof] - start.positions[dof];
      by_start += force_at_start[dof] * way;
      by_end += force[dof] * way;
    }
    return EnergyFlow{ false, 0., 0.5 * (by_start + by_end), 0.5 * std::abs(by_end - by_start) };
  }

  void
  LoadTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    sums->gradient -= force;
    sums->force_scale += force_norms;
    displacement = at.positions;
    displacement -= fe_space.rest_positions();
    sums->energy -= force * displacement;
  }

  std::size_t
  LoadTerm::memory_consumption() const
  {
    return force.memory_consumption() + force_at_start.memory_consumption()
           + force_norms.memory_consumption() + displacement.memory_consumption();
  }
} // namespace Exemplar
