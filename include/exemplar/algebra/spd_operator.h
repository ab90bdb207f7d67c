// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_spd_operator_h
#define exemplar_spd_operator_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/kept_inverse.h>
#include <exemplar/algebra/outer_products.h>
#include <exemplar/algebra/unknown_shear.h>
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
    unsigned int     version = 0; ///< number of rebuilds
    /// Whether terms of the matrix are given as OuterProducts instead, whose couplings are not in
    /// the pattern.
    bool products_are_apart = false;
    /// Whether its unknowns lie on a surface. Small separators then halve it, by which analyze() orders it.
    bool is_of_surface = false;
    /// The pattern without couplings that come and go, in whose order of elimination they may stand; null: it has
    /// none of these.
    std::shared_ptr<const SymmetricPattern> plain = {};

    unsigned int
    n() const
    {
      return column_start.empty() ? 0 : column_start.size() - 1;
    }

    /// Size of the array of values, padded: kernels write whole registers, which are zero behind
    /// the last value.
    std::size_t
    n_values() const
    {
      return row.size() + padding;
    }

    static constexpr std::size_t padding = 4;

    /// Position of entry (i,j), i >= j, which must be in the pattern.
    int
    position(const int i, const int j) const
    {
      const auto begin = row.begin() + column_start[j], end = row.begin() + column_start[j + 1];
      return static_cast<int>(std::lower_bound(begin, end, i) - row.begin());
    }
  };

  /// The exception for a matrix that is not positive definite.
  inline SolverFailure
  indefinite_matrix()
  {
    return SolverFailure("The matrix of the step is not positive definite. A body may be "
                         "without support, or cells may be inverted.");
  }

  /// Properties of an operator, independent of its library.
  struct OperatorTraits
  {
    std::string name;         ///< value of Solver/Linear solver
    double n_operations = 0.; ///< floating point operations of a factorisation; 0: nothing is known
    double pivot_ratio  = 0.; ///< greatest over least pivot of the last factor, a lower bound of
                              ///< the condition number; 0: there is none
    std::size_t bytes = 0;    ///< memory of matrix and factor; 0: not known
  };

  /// A sparse symmetric positive definite matrix and its factor or solver. The pattern is analysed
  /// once; values are then written in place and factorised anew.
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

    /// A further summand of the matrix, outer products by node, to be overwritten; null for an
    /// operator that assembles everything on its pattern.
    virtual OuterProducts *
    outer_products()
    {
      return nullptr;
    }

    /// The shear T of the unknowns, to be overwritten with the values, which are those of T^T A T for the matrix A that solve()
    /// inverts. Null: they are those of A itself.
    virtual UnknownShear *
    shear()
    {
      return nullptr;
    }

    /// Prepare for solve() with the current values. `positions` [m], by degree of freedom, are
    /// those of the state at which the matrix is the tangent: multigrid takes the rigid modes from
    /// them. Throws SolverFailure if the matrix is not positive definite.
    virtual void
    factorize(const Vector &positions)
        = 0;

    /// factorize() for solve() and keep() with a few digits only, enough for a metric.
    virtual void
    factorize_roughly(const Vector &positions)
    {
      factorize(positions);
    }

    /// factorize() of a matrix that has changed little since the last one, as in an iteration of Newton's method:
    /// multigrid keeps its hierarchy, as long as few iterations more are needed with it. Solutions then depend on the
    /// earlier matrix, too, within the tolerance.
    virtual void
    factorize_near(const Vector &positions)
    {
      factorize(positions);
    }

    /// Whether solve() uses anything of an earlier matrix than that of the last factorize_near().
    virtual bool
    leans_on_earlier() const
    {
      return false;
    }

    /// Overwrite columns C (n entries each, one after the other) by A^-1 C. Throws SolverFailure if
    /// the matrix turns out only here not to be positive definite. Where the operator iterates, it may end when
    /// the residual is `accuracy` times the column, if that is above its own tolerance.
    virtual void
    solve(std::vector<double> &columns, double accuracy = 0.)
        = 0;

    /// Whether solve() ends at a residual.
    virtual bool
    iterates() const
    {
      return false;
    }

    /// An independent operator on the same pattern, with its own values and factor, for concurrent
    /// use in another thread; null if not supported.
    virtual std::unique_ptr<SpdOperator>
    twin() const
    {
      return nullptr;
    }

    /// An approximate inverse that stays when the matrix changes. Throws SolverFailure if the
    /// operator has none.
    virtual std::unique_ptr<KeptInverse>
    keep() const = 0;
  };

  /// A sparse Cholesky factorisation by MultifrontalFactor in CHOLMOD's ordering; no result depends
  /// on the number of threads.
  std::unique_ptr<SpdOperator>
  make_cholesky_operator(unsigned int n_threads = 1);

  /// CHOLMOD's own factorisation, for checking.
  std::unique_ptr<SpdOperator>
  make_cholmod_operator();

  /// The sum of a matrix, of which this is the operator, and of a few OuterProducts of nodes with factors that are not negative, by the
  /// formula of Sherman, Morrison and Woodbury: as many more solves a factor. Throws SolverFailure as soon as the matrix without
  /// products is not positive definite. `free_dofs` must outlive the operator.
  std::unique_ptr<SpdOperator>
  make_low_rank_operator(std::unique_ptr<SpdOperator> matrix, const FreeDofs &free_dofs);

  /// A matrix A of n unknowns by the operator of T^T A T, see UnknownShear. entries() of its kept inverse may be asked of unknowns that stay
  /// alone.
  std::unique_ptr<SpdOperator>
  make_sheared_operator(std::unique_ptr<SpdOperator> matrix, std::size_t n);

  /// Conjugate gradients to a residual of `tolerance` times the right side, preconditioned with
  /// multigrid on the levels of ML's smoothed aggregation, whose coarse spaces hold the six rigid
  /// motions of the nodes. Results of factorize() and solve() depend on the matrix, the positions of the nodes and the
  /// right side alone. The pattern given to reinit() must outlive the operator. If springs far below single precision alone
  /// constrain rigid motions, `pieces` has the piece of each node of this process: RigidCorrection treats these motions.
  /// Throws UserError in a build without Trilinos, and where MPI neither runs nor may be started (MpiSession).
  std::unique_ptr<SpdOperator>
  make_iterative_operator(const FreeDofs           &free_dofs,
                          double                    tolerance,
                          std::vector<unsigned int> pieces = {});

  /// Whether this build has Trilinos, which make_iterative_operator() needs.
  bool
  has_iterative_operator();
} // namespace Exemplar

#endif
