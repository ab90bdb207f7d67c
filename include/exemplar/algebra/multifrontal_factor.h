// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multifrontal_factor_h
#define exemplar_multifrontal_factor_h

#include <exemplar/algebra/subtree_solve.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// A Cholesky factor by the multifrontal method (Duff and Reid, ACM TOMS 9, 1983): each
  /// supernode's panel is assembled from A's entries and its children's update matrices, is
  /// factorised, and leaves an update matrix to its parent. Subtrees run in parallel on several
  /// threads, and so do blocks within a large front of the top; the order of all sums depends on
  /// the structure alone, so that the factor is bitwise the same for any number of threads.
  template <typename Number>
  class MultifrontalFactor
  {
  public:
    /// `n_threads` >= 1.
    MultifrontalFactor(std::shared_ptr<const FactorStructure> structure, unsigned int n_threads);

    /// Factorise the matrix with these values on the pattern. Returns whether it is positive
    /// definite; if it is not, there is no factor afterwards.
    bool
    factorize(const std::vector<double> &values);

    /// Copy the panels of a factor of A.
    void
    assign(const double *panels);

    /// Overwrite columns C (n entries each, one after the other, in the order of A) by (get_scale()
    /// A)^-1 C.
    void
    solve(std::vector<Number> &columns);

    /// Forward substitution, as FrontKernels::forward, for one supernode.
    void
    forward(int supernode, Number *vector, Number *block) const;

    /// A power of two: get_scale() times A is factorised, so that it is in the range of single
    /// precision.
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

    /// Ratio of the greatest to the least pivot of L D L^T, the squared ratio of the diagonal of L.
    double
    pivot_ratio() const;

    /// Memory in bytes, with the structure.
    std::size_t
    memory_consumption() const;

  private:
    void
    finish();

    std::shared_ptr<const FactorStructure> structure;
    int                                    n_threads;
    double                                 scale = 1.;
    std::vector<Number>                    values; ///< panels, padded by a register
    std::vector<Number>                    inverse_diagonal;
    SubtreeSolve<Number>                   workspace;
  };
} // namespace Exemplar

#endif
