// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_potential_tangent_h
#define exemplar_potential_tangent_h

#include <exemplar/potential/elastic_body.h>
#include <exemplar/potential/potential_term.h>

#include <vector>

namespace Exemplar
{
  /// The matrix A and the columns G of an incremental potential, Eq. (10), and the pattern of A: those of
  /// the body and of terms.
  class PotentialTangent
  {
  public:
    /// The tangent of a body and of terms; all must outlive it. If `in_parts`, the pattern is without the couplings of
    /// outer products, and stays so.
    PotentialTangent(ElasticBody          &body,
                     const FreeDofs       &free_dofs,
                     const PotentialTerms &terms,
                     bool                  in_parts);

    /// The pattern of A.
    const SymmetricPattern &
    get_pattern() const
    {
      return pattern;
    }

    /// What terms couple in the pattern beside what the body does.
    const NodePairs &
    couplings_of_terms() const
    {
      return couplings;
    }

    /// From now on the pattern is one with the couplings of outer products, or without them.
    void
    assemble_in_parts(bool in_parts);

    /// Whether it is without them from the beginning.
    bool
    is_always_in_parts() const
    {
      return always_in_parts;
    }

    /// The free degrees of freedom, or the couplings of terms, are others from now on. All processes
    /// must call this.
    void
    renew_pattern();

    /// Do so if terms couple other nodes than the pattern knows, as after PotentialTerm::load(). All processes must
    /// call this.
    void
    follow_couplings();

    /// Which terms to take: those with gaps stay out of inverses that are kept, PotentialTerm::gap_width().
    enum class Terms
    {
      all,
      without_gaps
    };

    /// Let the pattern contain the couplings of these terms' gaps at these positions. Call it before each assembly. A new pattern
    /// keeps the couplings of the last one, and has a reserve: gaps up to twice their barrier distance. So pairs that open and
    /// close do not renew it in each iteration. A call without gaps ends that, and each step begins with one.
    void
    follow_gaps(const Vector &positions, Terms which);

    /// A term gets to know the pattern.
    void
    attach(PotentialTerm &term);

    /// A and G: exact for convexity 0, convex for 1, a mixture between. There must be `products`, which
    /// A is the sum of the values and, where the pattern is without them.
    void
    assemble(const Vector              &positions,
             const std::vector<double> &weights,
             double                     convexity,
             std::vector<double>       &matrix_values,
             std::vector<double>       &columns,
             OuterProducts             *products = nullptr,
             Terms                      which    = Terms::all);

  private:
    /// Make the pattern of body and terms as they are.
    void
    make_pattern_of_couplings(bool in_parts);

    /// Exact or convex.
    void
    assemble_one(Tangent                    kind,
                 const Vector              &positions,
                 const std::vector<double> &weights,
                 std::vector<double>       &values,
                 std::vector<double>       &columns,
                 OuterProducts             *products,
                 Terms                      which);

    ElasticBody          &body;
    const FreeDofs       &free_dofs;
    const PotentialTerms &terms;
    const bool            always_in_parts;
    NodePairs             couplings;     ///< of the terms
    NodePairs             gap_couplings; ///< of their gaps in this step, with a reserve; sorted
    SymmetricPattern      pattern;
    std::shared_ptr<const SymmetricPattern>
                 plain;        ///< the pattern without these couplings, if there are any
    unsigned int plain_of = 0; ///< FreeDofs::version() of that
  };
} // namespace Exemplar

#endif
