// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multifrontal_factor_h
#define exemplar_multifrontal_factor_h

#include <exemplar/algebra/subtree_solve.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// A Cholesky factor, made and solved with by the multifrontal method (Duff and Reid, ACM TOMS 9,
  /// 1983): each supernode's panel takes A's entries and what its children's fronts leave to it, is
  /// factorised, and leaves its own part to its parent. Subtrees are done at once by several threads,
  /// and so are blocks within a great front of the top; the order of all sums depends on the structure
  /// alone, so that the factor is the same to the byte for any number of threads.
  template <typename Number>
  class MultifrontalFactor
  {
  public:
    /// `n_threads` >= 1.
    MultifrontalFactor(std::shared_ptr<const FactorStructure> structure, unsigned int n_threads);

    /// Factorise the matrix with these values on the pattern. Returns whether it is positive definite;
    /// if it is not, there is no factor.
    bool
    factorize(const std::vector<double> &values);

    /// Take over the panels of a factor of A.
    void
    assign(const double *panels);

    /// Overwrite columns (n entries each, one after the other, in the order of A) by A^-1 times them, for A times
    /// get_scale().
    void
    solve(std::vector<Number> &columns);

    /// A power of two: what is factorised is A times this, so that single precision has room for it.
    double
    get_scale() const
    {
      return scale;
    }

    /// The values of the panels.
    const Number *
    get_values() const
    {
      return values.data();
    }

    const FactorStructure &
    get_structure() const
    {
      return *structure;
    }

    /// Greatest over least pivot, squared as those of L D L^T are.
    double
    pivot_ratio() const;

    /// In bytes, with the structure.
    std::size_t
    memory_consumption() const;

  private:
    void
    finish();

    std::shared_ptr<const FactorStructure> structure;
    int                                    n_threads;
    double                                 scale = 1.;
    std::vector<Number>                    values; ///< panels, and as many more as a register holds
    std::vector<Number>                    inverse_diagonal;
    SubtreeSolve<Number>                   workspace;
  };
} // namespace Exemplar

#endif
