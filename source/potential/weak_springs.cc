// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/weak_springs.h>

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
                           const Vector         &rest)
      : kind(kind), size(size), surface(surface), anchors(rest)
  {
  }

  void
  WeakSprings::begin_step(const Vector &positions)
  {
    in_step    = true;
    has_let_go = false;
    if (kind == FreeBodies::friction)
      anchors = positions;
    std::array<double, 2> sums{};
    for (const ContactSurface::Node &node : surface.nodes)
    {
      sums[0] += node.share;
      sums[1] += node.area;
    }
    free_dofs->exchange().sum(sums.data(), sums.size());
    by_area = size * sums[0] / (sums[1] * sums[1]);
  }

  bool
  WeakSprings::let_go()
  {
    const bool is_new = kind == FreeBodies::friction && in_step && !has_let_go;
    has_let_go |= is_new;
    return is_new;
  }

  double
  WeakSprings::stiffness(const ContactSurface::Node &node) const
  {
    const bool holds = kind == FreeBodies::friction && !has_let_go;
    return (holds ? until_friction_holds : weak) * by_area * node.area;
  }

  void
  WeakSprings::add(const Vector &positions, ElasticSums &sums) const
  {
    if (!in_step)
      return;
    for (const ContactSurface::Node &node : surface.nodes)
    {
      const double               k = stiffness(node);
      const dealii::Tensor<1, 3> u = at_node(positions, node.node) - at_node(anchors, node.node);
      sums->energy += 0.5 * k * u.norm_square();
      add_to(sums->gradient, node.node, k * u);
      sums->force_scale[node.node] += k * u.norm();
    }
  }

  double
  WeakSprings::lost_energy(const Vector &positions) const
  {
    double energy = 0.;
    if (kind == FreeBodies::friction && in_step)
      for (const ContactSurface::Node &node : surface.nodes)
        energy += 0.5 * stiffness(node)
                  * (at_node(positions, node.node) - at_node(anchors, node.node)).norm_square();
    return energy;
  }

  void
  WeakSprings::add_tangent(std::vector<double> &values) const
  {
    if (!in_step)
      return;
    for (const ContactSurface::Node &node : surface.nodes)
      for (unsigned int c = 0; c < 3; ++c)
        if (const int row = free_dofs->free_index(3 * node.node + c); row != FreeDofs::held)
          values[pattern->position(row, row)] += stiffness(node);
  }

  void
  WeakSprings::add_response(const Vector &displacement, ElasticSums &sums) const
  {
    if (!in_step)
      return;
    for (const ContactSurface::Node &node : surface.nodes)
      add_to(sums->gradient, node.node, stiffness(node) * at_node(displacement, node.node));
  }

  dealii::Tensor<1, 3>
  WeakSprings::force(const Vector &positions) const
  {
    dealii::Tensor<1, 3> sum;
    for (const ContactSurface::Node &node : surface.nodes)
      sum -= stiffness(node) * (at_node(positions, node.node) - at_node(anchors, node.node));
    return sum;
  }
} // namespace Exemplar
