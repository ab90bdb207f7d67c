// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/potential_tangent.h>

#include <algorithm>
#include <iterator>

namespace Exemplar
{
  namespace
  {
    NodePairs
    couplings_of(const PotentialTerms &terms)
    {
      NodePairs couplings;
      for (const auto &term : terms)
      {
        const NodePairs more = term->couplings();
        couplings.insert(couplings.end(), more.begin(), more.end());
      }
      return couplings;
    }

    /// Barrier distances up to which gaps are in a pattern that is made anew.
    constexpr double reserve_of_gaps = 2.;

    void
    sort(NodePairs &pairs)
    {
      std::sort(pairs.begin(), pairs.end());
      pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    }

    /// Couplings of gaps that have a barrier or friction at these positions.
    NodePairs
    couplings_of_gaps(const PotentialTerms &terms, const Vector &positions)
    {
      NodePairs couplings;
      for (const auto &term : terms)
        if (term->gap_width() > 0.)
        {
          const NodePairs more = term->couplings_of_gaps(positions);
          couplings.insert(couplings.end(), more.begin(), more.end());
        }
      sort(couplings);
      return couplings;
    }

    /// The same of gaps up to the reserve, for terms that couple nodes now.
    NodePairs
    reserve_of_couplings(const PotentialTerms &terms, const Vector &positions)
    {
      NodePairs couplings;
      for (const auto &term : terms)
      {
        if (!(term->gap_width() > 0.) || term->couplings_of_gaps(positions).empty())
          continue;
        std::vector<Gap> gaps;
        term->append_gaps(positions, reserve_of_gaps, gaps);
        for (const Gap &gap : gaps)
          for (unsigned int i = 0; i < gap.n_nodes; ++i)
            for (unsigned int j = 0; j < i; ++j)
              couplings.push_back(std::minmax({ gap.nodes[i], gap.nodes[j] }));
      }
      sort(couplings);
      return couplings;
    }

    NodePairs
    union_of(const NodePairs &a, const NodePairs &b)
    {
      NodePairs both;
      std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
      return both;
    }

    /// a + c (b - a)
    void
    mix(std::vector<double> &a, const std::vector<double> &b, const double c)
    {
      for (std::size_t i = 0; i < b.size(); ++i)
        a[i] += c * (b[i] - a[i]);
    }

    void
    mix(OuterProducts &a, OuterProducts &b, const double c)
    {
      a.scale(1. - c);
      b.scale(c);
      a.add(b);
    }
  } // namespace

  PotentialTangent::PotentialTangent(ElasticBody          &body,
                                     const FreeDofs       &free_dofs,
                                     const PotentialTerms &terms,
                                     const bool            in_parts)
      : body(body), free_dofs(free_dofs), terms(terms), always_in_parts(in_parts)
  {
    make_pattern_of_couplings(in_parts);
    body.attach(pattern);
    for (const auto &term : terms)
      attach(*term);
  }

  void
  PotentialTangent::attach(PotentialTerm &term)
  {
    term.attach(pattern, free_dofs);
  }

  void
  PotentialTangent::make_pattern_of_couplings(const bool in_parts)
  {
    couplings     = couplings_of(terms);
    NodePairs all = couplings;
    all.insert(all.end(), gap_couplings.begin(), gap_couplings.end());
    const bool has_plain = plain != nullptr && plain_of == free_dofs.version()
                           && plain->products_are_apart == in_parts;
    if (!has_plain)
      plain = all.empty()
                  ? nullptr
                  : std::make_shared<const SymmetricPattern>(body.make_pattern({}, in_parts));
    plain_of      = free_dofs.version();
    pattern       = body.make_pattern(all, in_parts);
    pattern.plain = plain;
  }

  void
  PotentialTangent::renew_pattern()
  {
    const unsigned int version = pattern.version;
    make_pattern_of_couplings(pattern.products_are_apart);
    pattern.version = version + 1;
    body.attach(pattern);
    for (const auto &term : terms)
      attach(*term);
  }

  void
  PotentialTangent::follow_couplings()
  {
    if (free_dofs.exchange().any(couplings != couplings_of(terms)))
      renew_pattern();
  }

  void
  PotentialTangent::follow_gaps(const Vector &positions, const Terms which)
  {
    const bool      has_gaps  = which == Terms::all;
    const NodePairs now       = has_gaps ? couplings_of_gaps(terms, positions) : NodePairs();
    const bool      is_enough = has_gaps ? std::includes(gap_couplings.begin(), gap_couplings.end(),
                                                         now.begin(), now.end())
                                         : gap_couplings.empty();
    if (!free_dofs.exchange().any(!is_enough))
      return;
    // pairs that open and close must not change the pattern in each iteration
    gap_couplings
        = has_gaps ? union_of(union_of(gap_couplings, now), reserve_of_couplings(terms, positions))
                   : NodePairs();
    renew_pattern();
  }

  void
  PotentialTangent::assemble_in_parts(const bool wanted)
  {
    const bool in_parts = wanted || always_in_parts;
    if (pattern.products_are_apart == in_parts)
      return;
    pattern.products_are_apart = in_parts;
    renew_pattern();
  }

  void
  PotentialTangent::assemble_one(const Tangent              kind,
                                 const Vector              &positions,
                                 const std::vector<double> &at_weights,
                                 std::vector<double>       &values,
                                 std::vector<double>       &columns,
                                 OuterProducts             *products,
                                 const Terms                which)
  {
    std::fill(values.begin(), values.end(), 0.);
    if (products != nullptr)
      products->clear();
    body.assemble_tangent(kind, positions, at_weights, values, columns, products);
    for (const auto &term : terms)
      if (which == Terms::all || term->gap_width() == 0.)
        term->add_tangent({ positions, at_weights }, kind, values, columns);
  }

  void
  PotentialTangent::assemble(const Vector              &positions,
                             const std::vector<double> &at_weights,
                             const double               convexity,
                             std::vector<double>       &matrix_values,
                             std::vector<double>       &columns,
                             OuterProducts             *products,
                             const Terms                which)
  {
    Assert(!(pattern.products_are_apart || body.has_dense_products()) || products != nullptr,
           dealii::ExcInternalError());
    if (!pattern.products_are_apart && !body.has_dense_products())
      products = nullptr; // all is on the pattern
    assemble_one(convexity < 1. ? Tangent::exact : Tangent::convex, positions, at_weights,
                 matrix_values, columns, products, which);
    if (convexity > 0. && convexity < 1.)
    {
      std::vector<double> convex_values(matrix_values.size()), convex_columns;
      OuterProducts       convex_products;
      assemble_one(Tangent::convex, positions, at_weights, convex_values, convex_columns,
                   products == nullptr ? nullptr : &convex_products, which);
      mix(matrix_values, convex_values, convexity);
      mix(columns, convex_columns, convexity);
      if (products != nullptr)
        mix(*products, convex_products, convexity);
    }
  }
} // namespace Exemplar
