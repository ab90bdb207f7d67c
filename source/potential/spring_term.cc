// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/spring_term.h>

namespace Exemplar
{
  void
  SpringTerm::attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs)
  {
    pattern   = &new_pattern;
    free_dofs = &new_free_dofs;
  }

  void
  SpringTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    for (const auto &[name, spring] : *springs)
      for (const Spring::End &end : spring.ends)
      {
        const dealii::Tensor<1, 3> stretch
            = at_node(at.positions, end.node) - spring.anchor - end.offset;
        const dealii::Tensor<1, 3> force = spring.stiffness * end.share * stretch;
        sums->energy += 0.5 * (force * stretch);
        add_to(sums->gradient, end.node, force);
        sums->force_scale[end.node] += force.norm();
      }
  }

  void
  SpringTerm::add_tangent(const TermPoint & /*at*/,
                          Tangent /*kind*/, // it is convex
                          std::vector<double> &values,
                          std::vector<double> & /*columns*/)
  {
    for (const auto &[name, spring] : *springs)
      for (const Spring::End &end : spring.ends)
        for (unsigned int c = 0; c < 3; ++c)
          if (const int i = free_dofs->free_index(3 * end.node + c); i >= 0)
            values[pattern->position(i, i)] += spring.stiffness * end.share;
  }

  void
  SpringTerm::add_response(const TermPoint & /*at*/,
                           Tangent /*kind*/,
                           const Vector &displacement,
                           ElasticSums  &sums)
  {
    for (const auto &[name, spring] : *springs)
      for (const Spring::End &end : spring.ends)
        add_to(sums->gradient, end.node,
               spring.stiffness * end.share * at_node(displacement, end.node));
  }

  std::size_t
  SpringTerm::memory_consumption() const
  {
    std::size_t n_bytes = 0;
    for (const auto &[name, spring] : *springs)
      n_bytes += sizeof(Springs::value_type) + spring.ends.size() * sizeof(Spring::End);
    return n_bytes;
  }
} // namespace Exemplar
