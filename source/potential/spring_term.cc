// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/spring_term.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Sum of the nodes' values, each with its share.
    dealii::Tensor<1, 3>
    at_point(const Spring &spring, const Vector &field)
    {
      dealii::Tensor<1, 3> sum;
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          sum[c] += spring.shares[a] * field[3 * spring.nodes[a] + c];
      return sum;
    }

    /// Give each node its share of a force.
    void
    add_shares(const Spring &spring, const dealii::Tensor<1, 3> &force, Vector &gradient)
    {
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          gradient[3 * spring.nodes[a] + c] += spring.shares[a] * force[c];
    }
  } // namespace

  void
  SpringTerm::attach(const SymmetricPattern &new_pattern,
                     const FreeDofs         &new_free_dofs,
                     CellField & /*cells*/)
  {
    pattern   = &new_pattern;
    free_dofs = &new_free_dofs;
  }

  void
  SpringTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    for (const auto &entry : *springs)
    {
      const Spring              &spring  = entry.second;
      const dealii::Tensor<1, 3> stretch = at_point(spring, at.positions) - spring.anchor;
      const dealii::Tensor<1, 3> force   = spring.stiffness * stretch;
      sums->energy += 0.5 * (force * stretch);
      add_shares(spring, force, sums->gradient);
      for (unsigned int a = 0; a < 3; ++a)
        sums->force_scale[spring.nodes[a]] += std::abs(spring.shares[a]) * force.norm();
    }
  }

  void
  SpringTerm::add_tangent(const TermPoint & /*at*/,
                          Tangent /*kind*/, // it is convex
                          std::vector<double> &values,
                          std::vector<double> & /*columns*/)
  {
    for (const auto &entry : *springs)
    {
      const Spring &spring = entry.second;
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          for (unsigned int c = 0; c < 3; ++c)
          {
            const int i = free_dofs->free_index(3 * spring.nodes[a] + c),
                      j = free_dofs->free_index(3 * spring.nodes[b] + c);
            if (i >= j && j >= 0)
              values[pattern->position(i, j)]
                  += spring.stiffness * spring.shares[a] * spring.shares[b];
          }
    }
  }

  void
  SpringTerm::add_response(const TermPoint & /*at*/,
                           Tangent /*kind*/,
                           const Vector &displacement,
                           ElasticSums  &sums)
  {
    for (const auto &entry : *springs)
      add_shares(entry.second, entry.second.stiffness * at_point(entry.second, displacement),
                 sums->gradient);
  }

  std::size_t
  SpringTerm::memory_consumption() const
  {
    return springs->size() * sizeof(Springs::value_type);
  }
} // namespace Exemplar
