// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_ties_h
#define exemplar_tests_ties_h

#include <exemplar/potential/potential_term.h>

#include <boost/serialization/vector.hpp>

#include <cmath>

namespace Exemplar::Testing
{
  /// When pairs of nodes tie and break.
  struct TieRules
  {
    NodePairs pairs;
    double    stiffness;                                               ///< k [N/m]
    double    reach;                                                   ///< [m]
    double    limit         = std::numeric_limits<double>::max();      ///< [m]
    double    greatest_step = std::numeric_limits<double>::infinity(); ///< of a node, in one go [m]
  };

  /// k/2 (d^2 - reach^2) of each pair of nodes at a distance d that is tied: a term that uses all of a term's life. A pair
  /// ties where an iteration begins with d < reach, and breaks for good at the end of a step with d > limit, which makes
  /// heat of its energy.
  class Ties : public PotentialTerm
  {
  public:
    explicit Ties(const TieRules &rules)
        : rules(rules), was_tied(rules.pairs.size(), 0), is_broken(rules.pairs.size(), 0),
          is_tied(was_tied)
    {
    }

    std::string
    name() const override
    {
      return "ties";
    }

    NodePairs
    couplings() const override
    {
      NodePairs tied;
      for_each_tied([&](const unsigned int a, const unsigned int b) { tied.emplace_back(a, b); });
      return tied;
    }

    void
    attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs) override
    {
      pattern   = &new_pattern;
      free_dofs = &new_free_dofs;
    }

    void
    begin_step(const State &, double) override
    {
      is_tied = was_tied;
    }

    TermChange
    renew(const TermPoint &at) override
    {
      const std::vector<char> before = is_tied;
      for (std::size_t i = 0; i < is_tied.size(); ++i)
        if (was_tied[i] == 0 && is_broken[i] == 0)
          is_tied[i] = square(at.positions, rules.pairs[i]) < rules.reach * rules.reach ? 1 : 0;
      return is_tied == before ? TermChange::none : TermChange::couplings;
    }

    std::optional<double>
    dissipation(const State &end) const override
    {
      double heat = 0.;
      for_each_tied(
          [&](const unsigned int a, const unsigned int b)
          {
            if (breaks(end.positions, { a, b }))
              heat += energy(end.positions, { a, b });
          });
      return heat;
    }

    void
    end_step(const State &end) override
    {
      for (std::size_t i = 0; i < is_tied.size(); ++i)
        if (is_tied[i] != 0 && breaks(end.positions, rules.pairs[i]))
        {
          is_broken[i] = 1;
          is_tied[i]   = 0;
        }
      was_tied = is_tied;
    }

    void
    add(const TermPoint &at, ElasticSums &sums) override
    {
      for_each_tied(
          [&](const unsigned int a, const unsigned int b)
          {
            sums->energy += energy(at.positions, { a, b });
            for (unsigned int c = 0; c < 3; ++c)
            {
              const double force
                  = rules.stiffness * (at.positions[3 * a + c] - at.positions[3 * b + c]);
              sums->gradient[3 * a + c] += force;
              sums->gradient[3 * b + c] -= force;
              sums->force_scale[a] += std::abs(force);
              sums->force_scale[b] += std::abs(force);
            }
          });
    }

    void
    add_tangent(const TermPoint &,
                Tangent,
                std::vector<double> &values,
                std::vector<double> &) override
    {
      const auto add = [&](const unsigned int row, const unsigned int column, const double value)
      {
        const int i = free_dofs->free_index(row), j = free_dofs->free_index(column);
        if (i != FreeDofs::held && j != FreeDofs::held)
          values[pattern->position(std::max(i, j), std::min(i, j))] += value;
      };
      for_each_tied(
          [&](const unsigned int a, const unsigned int b)
          {
            for (unsigned int c = 0; c < 3; ++c)
            {
              add(3 * a + c, 3 * a + c, rules.stiffness);
              add(3 * b + c, 3 * b + c, rules.stiffness);
              add(3 * a + c, 3 * b + c, -rules.stiffness);
            }
          });
    }

    void
    add_response(const TermPoint &, Tangent, const Vector &displacement, ElasticSums &sums) override
    {
      for_each_tied(
          [&](const unsigned int a, const unsigned int b)
          {
            for (unsigned int c = 0; c < 3; ++c)
            {
              const double force
                  = rules.stiffness * (displacement[3 * a + c] - displacement[3 * b + c]);
              sums->gradient[3 * a + c] += force;
              sums->gradient[3 * b + c] -= force;
            }
          });
    }

    double
    max_step(const Vector &, const Vector &displacement) const override
    {
      const double longest = displacement.linfty_norm();
      return longest > 0. ? rules.greatest_step / longest : std::numeric_limits<double>::infinity();
    }

    void
    append_columns(const double                                 energy,
                   std::vector<std::pair<std::string, double>> &columns) const override
    {
      columns.emplace_back("energy_ties", energy);
      columns.emplace_back("ties", std::count(is_tied.begin(), is_tied.end(), 1));
    }

    void
    append_fields(const Vector &positions, std::vector<NodalField> &fields) const override
    {
      NodalField force{ "force_of_ties", Vector(positions.size()) };
      for_each_tied(
          [&](const unsigned int a, const unsigned int b)
          {
            for (unsigned int c = 0; c < 3; ++c)
            {
              const double of_a = rules.stiffness * (positions[3 * b + c] - positions[3 * a + c]);
              force.values[3 * a + c] += of_a;
              force.values[3 * b + c] -= of_a;
            }
          });
      fields.push_back(std::move(force));
    }

    void
    save(boost::archive::binary_oarchive &archive) const override
    {
      archive &was_tied &is_broken;
    }

    void
    load(boost::archive::binary_iarchive &archive) override
    {
      archive &was_tied &is_broken;
      is_tied = was_tied;
    }

    std::size_t
    memory_consumption() const override
    {
      return 3 * is_tied.size();
    }

  private:
    using Pair = std::pair<unsigned int, unsigned int>;

    template <typename Function>
    void
    for_each_tied(const Function &function) const
    {
      for (std::size_t i = 0; i < is_tied.size(); ++i)
        if (is_tied[i] != 0)
          function(rules.pairs[i].first, rules.pairs[i].second);
    }

    /// d^2
    static double
    square(const Vector &x, const Pair &pair)
    {
      double sum = 0.;
      for (unsigned int c = 0; c < 3; ++c)
        sum += std::pow(x[3 * pair.first + c] - x[3 * pair.second + c], 2);
      return sum;
    }

    double
    energy(const Vector &x, const Pair &pair) const
    {
      return 0.5 * rules.stiffness * (square(x, pair) - rules.reach * rules.reach);
    }

    bool
    breaks(const Vector &x, const Pair &pair) const
    {
      return square(x, pair) > rules.limit * rules.limit;
    }

    const TieRules          rules;
    std::vector<char>       was_tied, is_broken; ///< since the last step
    std::vector<char>       is_tied;             ///< in this step
    const SymmetricPattern *pattern   = nullptr; ///< since attach()
    const FreeDofs         *free_dofs = nullptr; ///< since attach()
  };
} // namespace Exemplar::Testing

#endif
