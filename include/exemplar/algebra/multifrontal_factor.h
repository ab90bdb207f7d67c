// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multifrontal_factor_h
#define exemplar_multifrontal_factor_h

#include <exemplar/algebra/front_kernels.h>

#include <memory>
#include <utility>
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

    /// Take a factor of A from CHOLMOD's panels: each has a supernode's columns one after the other, all rows of each.
    void
    assign(const double *panels);

    /// Take a factor in another precision.
    template <typename Other>
    void
    assign(const MultifrontalFactor<Other> &other);

    /// Forward substitution, as FrontKernels::forward, for one supernode.
    void
    forward(const int supernode, const SupernodeVectors<Number> &of_supernodes) const
    {
      kernels.forward(*structure, values.get(), supernode, supernode + 1, of_supernodes);
    }

    /// A power of two: get_scale() times A is factorised, so that it is in the range of single
    /// precision.
    double
    get_scale() const
    {
      return scale;
    }

    /// Overwrite columns C (n entries each, one after the other, in the order of A) by A^-1 C.
    void
    solve(std::vector<double> &columns);

    /// The values of the panels, PanelBlock by PanelBlock, and some numbers behind them.
    const Number *
    get_values() const
    {
      return values.get();
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
    /// Gives aligned memory back.
    struct Free
    {
      void
      operator()(Number *numbers) const;
    };
    using Numbers = std::unique_ptr<Number[], Free>;

    static Numbers
    allocate(std::size_t n);

    /// Call function(s, block) for all blocks of the supernodes' panels.
    template <typename Function>
    void
    for_each_block(const Function &function) const;

    /// Call function(row of A, entry) for all entries of one right side in the vectors of supernodes.
    template <typename Function>
    void
    for_each_own_row(Number *vector, const Function &function) const;

    /// Solve for so many columns at once.
    void
    solve(double *columns, int number);

    /// The least and the greatest entry of L's diagonal.
    std::pair<double, double>
    diagonal_range() const;

    std::shared_ptr<const FactorStructure> structure;
    const FrontKernels<Number>            &kernels;
    int                                    n_threads;
    double                                 scale = 1.; ///< a power of two: A times it is factorised
    Numbers                                values;  ///< at the begin of a line of the cache, or two
    std::vector<Number>                    vectors; ///< of supernodes, for several right sides

    template <typename Other>
    friend class MultifrontalFactor;
  };
} // namespace Exemplar

#endif
