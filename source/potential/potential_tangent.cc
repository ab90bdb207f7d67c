// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/potential_tangent.h>

#include <algorithm>

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
    NodePairs now;
    for (const auto &term : terms)
      if (which == Terms::all && term->gap_width() > 0.)
      {
        const NodePairs more = term->couplings_of_gaps(positions);
        now.insert(now.end(), more.begin(), more.end());
      }
    if (!free_dofs.exchange().any(now != gap_couplings))
      return;
    gap_couplings.swap(now);
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
    Assert(!(pattern.products_are_apart || body.has_dense_products()) || products != nullptr, dealii::ExcInternalError());
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
