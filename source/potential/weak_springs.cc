// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/weak_springs.h>

#include <algorithm>
#include <array>

namespace Exemplar
{
  namespace
  {
    constexpr double weak = 1e-6; ///< of E L
    /// The same until the normal forces of friction are known, which only then can hold the body.
    constexpr double until_friction_holds = 1e-2;
  } // namespace

  WeakSprings::WeakSprings(const FreeBodies      kind,
                           const double          size,
                           const ContactSurface &surface,
                           const Material       &material,
                           const FESpace        &fe_space,
                           const ObstacleTerm   &obstacles)
      : kind(kind), size(size), surface(surface), material(material), obstacles(obstacles),
        pieces(fe_space.numbering().pieces()), anchors(fe_space.rest_positions())
  {
    follow_parameters();
  }

  void
  WeakSprings::begin_step(const State &start, const double /*step_size*/)
  {
    in_step    = true;
    has_let_go = kind != FreeBodies::friction; // renew() finds out whether there is friction
    n_looks = n_renewals = 0;
    held_at              = start.positions;
    if (kind == FreeBodies::friction)
      anchors = start.positions;
    std::array<double, 2> sums{};
    for (const ContactSurface::Node &node : surface.nodes)
    {
      sums[0] += node.share;
      sums[1] += node.area;
    }
    free_dofs->exchange().sum(sums.data(), sums.size());
    by_area = size * sums[0] / (sums[1] * sums[1]);
  }

  TermChange
  WeakSprings::renew(const TermPoint &at)
  {
    const ObstacleTerm::Step &friction = obstacles.get_step();
    if (!in_step || friction.n_looks == n_looks)
      return TermChange::none;
    n_looks           = friction.n_looks;
    TermChange change = TermChange::none;
    // where a step begins nothing may push yet
    if (const bool lets_go = friction.greatest_force > 0. || n_looks > 1; lets_go != has_let_go)
    {
      has_let_go = lets_go;
      change     = TermChange::values;
    }
    if (kind != FreeBodies::friction)
      return change;
    // what an obstacle carries along goes far from its anchors, and stiff springs would bear its weight
    const double allowed = obstacles.lag_tolerance() * friction.greatest_force;
    if (allowed > 0. && has_settled() && greatest_force(at.positions) > allowed)
    {
      ++n_renewals;
      anchors = at.positions;
      change  = TermChange::values;
    }
    return change;
  }

  double
  WeakSprings::stiffness(const ContactSurface::Node &node) const
  {
    return (has_let_go ? weak : until_friction_holds) * by_area * node.area;
  }

  double
  WeakSprings::stiffness(const ContactSurface::Node &node, const Tangent tangent) const
  {
    return tangent == Tangent::exact ? stiffness(node) : until_friction_holds * by_area * node.area;
  }

  SpaceVector3
  WeakSprings::stretch(const ContactSurface::Node &node, const Vector &positions) const
  {
    return at_node(positions, node.node) - at_node(has_let_go ? anchors : held_at, node.node);
  }

  double
  WeakSprings::greatest_force(const Vector &positions) const
  {
    double greatest = 0.;
    for (const ContactSurface::Node &node : surface.nodes)
      greatest = std::max(greatest, stiffness(node) * stretch(node, positions).norm());
    return free_dofs->exchange().max(greatest);
  }

  void
  WeakSprings::end_step(const State &end)
  {
    force = SpaceVector3();
    for (const ContactSurface::Node &node : surface.nodes)
      force -= stiffness(node) * stretch(node, end.positions);
  }

  void
  WeakSprings::add(const TermPoint &at, ElasticSums &sums)
  {
    if (!in_step)
      return;
    for (const ContactSurface::Node &node : surface.nodes)
    {
      const double       k = stiffness(node);
      const SpaceVector3 u = stretch(node, at.positions);
      sums->energy += 0.5 * k * u.norm_square();
      add_to(sums->gradient, node.node, k * u);
      sums->force_scale[node.node] += k * u.norm();
    }
  }

  std::optional<EnergyFlow>
  WeakSprings::energy_flow(const State & /*start*/, const State &end) const
  {
    EnergyFlow flow;
    if (kind == FreeBodies::friction && in_step)
      for (const ContactSurface::Node &node : surface.nodes)
        flow.lost += 0.5 * stiffness(node) * stretch(node, end.positions).norm_square();
    return flow;
  }

  void
  WeakSprings::add_tangent(const TermPoint & /*at*/,
                           const Tangent        tangent,
                           std::vector<double> &values,
                           std::vector<double> & /*columns*/)
  {
    if (!in_step)
      return;
    for (const ContactSurface::Node &node : surface.nodes)
      for (unsigned int c = 0; c < 3; ++c)
        if (const int row = free_dofs->free_index(3 * node.node + c); row != FreeDofs::held)
          values[pattern->position(row, row)] += stiffness(node, tangent);
  }

  void
  WeakSprings::add_response(const TermPoint & /*at*/,
                            const Tangent tangent,
                            const Vector &displacement,
                            ElasticSums  &sums)
  {
    if (!in_step)
      return;
    for (const ContactSurface::Node &node : surface.nodes)
      add_to(sums->gradient, node.node,
             stiffness(node, tangent) * at_node(displacement, node.node));
  }

  void
  WeakSprings::append_columns(const double /*energy*/,
                              std::vector<std::pair<std::string, double>> &columns) const
  {
    for (unsigned int c = 0; c < 3 && kind == FreeBodies::weak_springs; ++c)
      columns.emplace_back(std::string("weak_springs_") + "xyz"[c],
                           free_dofs -> exchange().sum(force[c]));
  }

  void
  WeakSprings::save(boost::archive::binary_oarchive &archive) const
  {
    archive << force;
  }

  void
  WeakSprings::load(boost::archive::binary_iarchive &archive)
  {
    archive >> force;
  }
} // namespace Exemplar
