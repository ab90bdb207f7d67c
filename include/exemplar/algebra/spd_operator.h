// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_spd_operator_h
#define exemplar_spd_operator_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/single_precision_factor.h>
#include <exemplar/base/errors.h>

#include <deal.II/lac/vector.h>

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

  /// A sparse symmetric positive definite matrix and its factor, or what stands for one.
  /// The pattern is analysed once; values are then written in place and factorised anew.
  class SpdOperator
  {
  public:
    virtual ~SpdOperator() = default;

    /// As Solver/Linear solver names it.
    virtual std::string
    name() const = 0;

    /// Throws SolverFailure if the pattern is too large for the library.
    virtual void
    reinit(const SymmetricPattern &pattern)
        = 0;

    /// Values on the pattern and the padding, to be overwritten.
    virtual std::vector<double> &
    values()
        = 0;

    /// Floating point operations of factorize() for this pattern; 0 if nothing is known.
    virtual double
    n_operations() const
    {
      return 0.;
    }

    /// The ratio of the greatest to the least pivot of the last factor, which the condition
    /// number is not below; 0 if there is none.
    virtual double
    condition_estimate()
    {
      return 0.;
    }

    /// Of the matrix and its factor, or what stands for one, in bytes.
    virtual std::size_t
    memory_consumption() const = 0;

    /// Where the nodes are in the state of which the next matrix is the tangent. Operators
    /// that ask nothing of it ignore it.
    virtual void
    place_nodes(const dealii::Vector<double> & /*positions*/)
    {
    }

    /// Throws SolverFailure if the matrix is not positive definite.
    virtual void
    factorize()
        = 0;

    /// Overwrite the columns (n entries each, one after the other) by A^-1 times them.
    /// Throws SolverFailure if the matrix turns out not to be positive definite only here.
    virtual void
    solve(std::vector<double> &columns)
        = 0;

    /// A copy of the factor in single precision. Throws SolverFailure if there is none.
    virtual FactorPanels
    panels() const = 0;
  };

  /// CHOLMOD's sparse Cholesky factorisation.
  std::unique_ptr<SpdOperator>
  make_cholmod_operator();

  /// Conjugate gradients to a residual of `tolerance` times the right side, preconditioned
  /// with ML's smoothed aggregation, whose coarse spaces hold the six rigid motions of the
  /// nodes. Results depend on the matrix, the place of the nodes and the right side alone.
  /// Throws UserError in a build without Trilinos, and where MPI neither runs nor may be started
  /// (MpiSession).
  std::unique_ptr<SpdOperator>
  make_iterative_operator(const FreeDofs               &free_dofs,
                          const dealii::Vector<double> &rest_positions,
                          double                        tolerance);

  /// Whether this is a build with Trilinos, of which make_iterative_operator() makes use.
  bool
  has_iterative_operator();
} // namespace Exemplar

#endif
