// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/potential_tangent.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Of cells and terms.
    SymmetricPattern
    pattern_of(const FESpace        &fe_space,
               const PotentialTerms &elastic_terms,
               const PotentialTerms &terms,
               const FreeDofs       &free_dofs,
               const bool            in_parts)
    {
      NodePairs couplings;
      for (const PotentialTerms *some : { &elastic_terms, &terms })
        for (const auto &term : *some)
          if (!in_parts || !term->couples_by_products())
          {
            const NodePairs more = term->couplings();
            couplings.insert(couplings.end(), more.begin(), more.end());
          }
      SymmetricPattern pattern   = make_pattern(fe_space, couplings, free_dofs);
      pattern.products_are_apart = in_parts;
      return pattern;
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

  PotentialTangent::PotentialTangent(const ElasticParts   &parts,
                                     const PotentialTerms &elastic_terms,
                                     ElasticPotential     &cells,
                                     const PotentialTerms &terms,
                                     const bool            in_parts)
      : fe_space(parts.fe_space), free_dofs(parts.free_dofs), cells(cells), terms(terms),
        pattern(pattern_of(fe_space, elastic_terms, terms, free_dofs, in_parts))
  {
  }

  void
  PotentialTangent::attach(PotentialTerm &term)
  {
    term.attach(pattern, free_dofs, cells.get_field());
  }

  void
  PotentialTangent::renew_pattern()
  {
    const unsigned int version = pattern.version;
    pattern = pattern_of(fe_space, cells.get_terms(), terms, free_dofs, pattern.products_are_apart);
    pattern.version = version + 1;
    cells.follow_pattern();
    for (const auto &term : terms)
      attach(*term);
  }

  void
  PotentialTangent::assemble_in_parts(const bool in_parts)
  {
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
                                 OuterProducts             *products)
  {
    std::fill(values.begin(), values.end(), 0.);
    if (products != nullptr)
      products->clear();
    cells.assemble_tangent(kind, positions, at_weights, values, columns, products);
    for (const auto &term : terms)
      add_tangent_of(*term, { positions, at_weights }, kind, values, columns, products);
  }

  void
  PotentialTangent::assemble(const Vector              &positions,
                             const std::vector<double> &at_weights,
                             const double               convexity,
                             std::vector<double>       &matrix_values,
                             std::vector<double>       &columns,
                             OuterProducts             *products)
  {
    Assert(!pattern.products_are_apart || products != nullptr, dealii::ExcInternalError());
    if (!pattern.products_are_apart)
      products = nullptr; // all is on the pattern
    assemble_one(convexity < 1. ? Tangent::exact : Tangent::convex, positions, at_weights,
                 matrix_values, columns, products);
    if (convexity > 0. && convexity < 1.)
    {
      std::vector<double> convex_values(matrix_values.size()), convex_columns;
      OuterProducts       convex_products;
      assemble_one(Tangent::convex, positions, at_weights, convex_values, convex_columns,
                   products == nullptr ? nullptr : &convex_products);
      mix(matrix_values, convex_values, convexity);
      mix(columns, convex_columns, convexity);
      if (products != nullptr)
        mix(*products, convex_products, convexity);
    }
  }
} // namespace Exemplar
