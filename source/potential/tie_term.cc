// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/tie_term.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    constexpr double rigid_factor = 1e4; ///< of the softer side's stiffness
    constexpr double most_of_rigid
        = 1e3; ///< of a rigid tie's stiffness: beyond, the rounding of positions is a force
  }

  TieTerm::TieTerm(const Ties &ties, const Material &material)
      : ties(ties), material(material), forces(ties.get_groups().size())
  {
    follow_parameters();
  }

  template <typename Visit>
  void
  TieTerm::visit_ties(const Visit &visit) const
  {
    for (std::size_t g = 0; g < stiffness.size(); ++g)
      for (std::size_t i = 0; i < stiffness[g].size(); ++i)
        visit(ties.get_groups()[g].ties[i], stiffness[g][i]);
  }

  NodePairs
  TieTerm::couplings() const
  {
    NodePairs pairs;
    for (const Ties::Group &group : ties.get_groups())
      for (const Tie &tie : group.ties)
        for (const unsigned int other : tie.others)
          pairs.push_back(std::minmax({ tie.node, other }));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  void
  TieTerm::attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs)
  {
    pattern   = &new_pattern;
    free_dofs = &new_free_dofs;
  }

  void
  TieTerm::follow_parameters()
  {
    stiffness.clear();
    for (const Ties::Group &group : ties.get_groups())
    {
      stiffness.emplace_back();
      for (const Tie &tie : group.ties)
      {
        const double softer
            = std::min(material.youngs_modulus(tie.own_cell), material.youngs_modulus(tie.cell));
        const double rigid = rigid_factor * softer * std::sqrt(tie.area);
        if (group.stiffness * tie.area > most_of_rigid * rigid)
          throw UserError(fmt::format("Ties/{}/Stiffness = {} is so great that forces would be the "
                                      "rounding of positions. Allowed: rigid, or at most "
                                      "{} N/m^3, a thousand times as stiff.",
                                      group.name, short_text(group.stiffness),
                                      short_text(most_of_rigid * rigid / tie.area)));
        stiffness.back().push_back(group.stiffness > 0. ? group.stiffness * tie.area : rigid);
      }
    }
  }

  dealii::Tensor<1, 3>
  TieTerm::stretch(const Tie &tie, const Vector &positions)
  {
    dealii::Tensor<1, 3> result = at_node(positions, tie.node);
    for (std::size_t j = 0; j < tie.others.size(); ++j)
      result -= tie.shares[j] * at_node(positions, tie.others[j]);
    return result;
  }

  void
  TieTerm::end_step(const State &end)
  {
    std::size_t g = 0;
    for (const Ties::Group &group : ties.get_groups())
    {
      forces[g] = {};
      for (std::size_t i = 0; i < group.ties.size(); ++i)
      {
        const dealii::Tensor<1, 3> force = -stiffness[g][i] * stretch(group.ties[i], end.positions);
        for (unsigned int c = 0; c < 3; ++c)
          forces[g][c] += force[c];
      }
      ++g;
    }
  }

  void
  TieTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    visit_ties(
        [&](const Tie &tie, const double k)
        {
          const dealii::Tensor<1, 3> way = stretch(tie, at.positions), force = k * way;
          sums->energy += 0.5 * (force * way);
          add_to(sums->gradient, tie.node, force);
          sums->force_scale[tie.node] += force.norm();
          for (std::size_t j = 0; j < tie.others.size(); ++j)
          {
            add_to(sums->gradient, tie.others[j], -tie.shares[j] * force);
            sums->force_scale[tie.others[j]] += std::abs(tie.shares[j]) * force.norm();
          }
        });
  }

  void
  TieTerm::add_tangent(const TermPoint & /*at*/,
                       Tangent /*kind*/, // it is convex
                       std::vector<double> &values,
                       std::vector<double> & /*columns*/)
  {
    const auto add_entry = [&](const unsigned int node, const unsigned int other, const double k)
    {
      for (unsigned int c = 0; c < 3; ++c)
      {
        const int row    = free_dofs->free_index(3 * node + c);
        const int column = free_dofs->free_index(3 * other + c);
        if (row != FreeDofs::held && column != FreeDofs::held && row >= column)
          values[pattern->position(row, column)] += k;
      }
    };
    visit_ties(
        [&](const Tie &tie, const double k)
        {
          add_entry(tie.node, tie.node, k);
          for (std::size_t i = 0; i < tie.others.size(); ++i)
          {
            add_entry(tie.node, tie.others[i], -k * tie.shares[i]);
            add_entry(tie.others[i], tie.node, -k * tie.shares[i]);
            for (std::size_t j = 0; j < tie.others.size(); ++j)
              add_entry(tie.others[i], tie.others[j], k * tie.shares[i] * tie.shares[j]);
          }
        });
  }

  void
  TieTerm::add_response(const TermPoint & /*at*/,
                        Tangent /*kind*/,
                        const Vector &displacement,
                        ElasticSums  &sums)
  {
    visit_ties(
        [&](const Tie &tie, const double k)
        {
          const dealii::Tensor<1, 3> force = k * stretch(tie, displacement);
          add_to(sums->gradient, tie.node, force);
          for (std::size_t j = 0; j < tie.others.size(); ++j)
            add_to(sums->gradient, tie.others[j], -tie.shares[j] * force);
        });
  }

  double
  TieTerm::rounding_force(const Vector &positions) const
  {
    double stiffest = 0.;
    visit_ties(
        [&](const Tie &tie, const double k)
        {
          double shares = 1.;
          for (const double share : tie.shares)
            shares += std::abs(share);
          stiffest = std::max(stiffest, k * shares);
        });
    return std::numeric_limits<double>::epsilon() * stiffest
           * max_entry(positions.begin(), positions.end());
  }

  void
  TieTerm::append_columns(const double                                 energy,
                          std::vector<std::pair<std::string, double>> &columns) const
  {
    columns.emplace_back("energy_ties", energy);
    for (std::size_t g = 0; g < forces.size(); ++g)
      for (unsigned int c = 0; c < 3; ++c)
        columns.emplace_back("tie_" + ties.get_groups()[g].name + "_" + "xyz"[c], forces[g][c]);
  }

  void
  TieTerm::append_fields(const Vector &positions, std::vector<NodalField> &fields) const
  {
    NodalField force{ "tie_force", Vector(positions.size()) };
    visit_ties(
        [&](const Tie &tie, const double k)
        {
          const dealii::Tensor<1, 3> on_node = -k * stretch(tie, positions);
          add_to(force.values, tie.node, on_node);
          for (std::size_t j = 0; j < tie.others.size(); ++j)
            add_to(force.values, tie.others[j], -tie.shares[j] * on_node);
        });
    fields.push_back(std::move(force));
  }

  void
  TieTerm::save(boost::archive::binary_oarchive &archive) const
  {
    for (const auto &force : forces)
      archive << force[0] << force[1] << force[2];
  }

  void
  TieTerm::load(boost::archive::binary_iarchive &archive)
  {
    for (auto &force : forces)
      archive >> force[0] >> force[1] >> force[2];
  }

  std::size_t
  TieTerm::memory_consumption() const
  {
    std::size_t n = 0;
    for (const auto &of_group : stiffness)
      n += of_group.size();
    return ties.memory_consumption() + n * sizeof(double);
  }
} // namespace Exemplar
