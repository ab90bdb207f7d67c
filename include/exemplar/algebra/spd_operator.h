// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_spd_operator_h
#define exemplar_spd_operator_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/kept_inverse.h>
#include <exemplar/algebra/outer_products.h>
#include <exemplar/algebra/vector.h>
#include <exemplar/base/errors.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Lower triangle of a symmetric n x n pattern by columns; row indices ascend in
  /// each column and start with the diagonal.
  struct SymmetricPattern
  {
    std::vector<int> column_start; ///< n + 1 entries
    std::vector<int> row;
    unsigned int     version = 0; ///< how often it was made anew
    /// Whether values on it lack what terms give as OuterProducts, of which the couplings are no part
    /// of it.
    bool products_are_apart = false;
    /// The pattern without couplings that come and go, in whose order of elimination they may stand; null: it has
    /// none of these.
    std::shared_ptr<const SymmetricPattern> plain = {};

    unsigned int
    n() const
    {
      return column_start.empty() ? 0 : column_start.size() - 1;
    }

    /// Size of the array of values: kernels write whole registers, and what they write
    /// behind the last value is zero.
    std::size_t
    n_values() const
    {
      return row.size() + padding;
    }

    static constexpr std::size_t padding = 4;

    /// Position of entry (i,j), i >= j, which must be there.
    int
    position(const int i, const int j) const
    {
      const auto begin = row.begin() + column_start[j], end = row.begin() + column_start[j + 1];
      return static_cast<int>(std::lower_bound(begin, end, i) - row.begin());
    }
  };

  /// What operators throw if their matrix is not positive definite.
  inline SolverFailure
  indefinite_matrix()
  {
    return SolverFailure("The matrix of the step is not positive definite. A body may be "
                         "without support, or cells may be inverted.");
  }

  /// What an operator tells of itself, in the terms of no library.
  struct OperatorTraits
  {
    std::string name;         ///< as Solver/Linear solver names it
    double n_operations = 0.; ///< floating point operations of a factorisation; 0: nothing is known
    double pivot_ratio  = 0.; ///< greatest over least pivot of the last factor, which the condition
                              ///< number is not below; 0: there is none
    std::size_t bytes = 0;    ///< of matrix and factor; 0: it does not tell
  };

  /// A sparse symmetric positive definite matrix and its factor, or what stands for one.
  /// The pattern is analysed once; values are then written in place and factorised anew.
  class SpdOperator
  {
  public:
    virtual ~SpdOperator() = default;

    virtual OperatorTraits
    traits() const = 0;

    /// Have this pattern from now on, in an order of elimination that depends on it and its plain one alone. Throws
    /// SolverFailure if the pattern is too large for the library.
    virtual void
    reinit(const SymmetricPattern &pattern)
        = 0;

    /// Values on the pattern and the padding, to be overwritten.
    virtual std::vector<double> &
    values()
        = 0;

    /// By node, a further summand of the matrix, to be overwritten; null for an operator that takes
    /// none, and has all on its pattern.
    virtual OuterProducts *
    outer_products()
    {
      return nullptr;
    }

    /// Prepare for solve() with the values as they are. `positions` [m], by degree of freedom,
    /// are those of the state of which the matrix is the tangent: multigrid takes the rigid
    /// motions from there. Throws SolverFailure if the matrix is not positive definite.
    virtual void
    factorize(const Vector &positions)
        = 0;

    /// The same where solve() and keep() need a few digits only, as those of a metric.
    virtual void
    factorize_roughly(const Vector &positions)
    {
      factorize(positions);
    }

    /// Overwrite the columns (n entries each, one after the other) by A^-1 times them.
    /// Throws SolverFailure if the matrix turns out not to be positive definite only here.
    virtual void
    solve(std::vector<double> &columns)
        = 0;

    /// Another operator of the same pattern, with values and a factor of its own, which another thread may make
    /// at the same time; null for an operator that has none.
    virtual std::unique_ptr<SpdOperator>
    twin() const
    {
      return nullptr;
    }

    /// What serves as inverse when the matrix has changed. Throws SolverFailure if the operator
    /// has nothing of the kind.
    virtual std::unique_ptr<KeptInverse>
    keep() const = 0;
  };

  /// A sparse Cholesky factorisation in the order that CHOLMOD finds, by MultifrontalFactor; no result
  /// depends on the number of threads.
  std::unique_ptr<SpdOperator>
  make_cholesky_operator(unsigned int n_threads = 1);

  /// CHOLMOD's own, for checking.
  std::unique_ptr<SpdOperator>
  make_cholmod_operator();

  /// Conjugate gradients to a residual of `tolerance` times the right side, preconditioned
  /// with multigrid on the levels of ML's smoothed aggregation, whose coarse spaces hold the six rigid
  /// motions of the nodes. Results depend on the matrix, the positions of the nodes and the right side alone.
  /// The pattern that reinit() is given must outlive it.
  /// Throws UserError in a build without Trilinos, and where MPI neither runs nor may be started
  /// (MpiSession).
  std::unique_ptr<SpdOperator>
  make_iterative_operator(const FreeDofs &free_dofs, double tolerance);

  /// Whether this is a build with Trilinos, of which make_iterative_operator() makes use.
  bool
  has_iterative_operator();
} // namespace Exemplar

#endif
