// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_bordered_solver_h
#define exemplar_bordered_solver_h

#include <exemplar/algebra/spd_operator.h>

#include <deal.II/lac/full_matrix.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// The blocks beside A of the linear system of a step with k weights and m linear
  /// constraints on them, Eq. (10):
  ///
  ///     [  A    -G    0  ] [ dx ]   [ r_x ]
  ///     [ -G^T   H   N^T ] [ dw ] = [ r_w ]
  ///     [  0     N    0  ] [ l  ]   [ r_c ]
  ///
  /// N has a row a region, of ones where the weights are the region's; they are k/m
  /// consecutive ones. Global weights are one region. k = 0 if the scene has no weights to
  /// find.
  struct WeightBlock
  {
    std::vector<unsigned int>  coupled;  ///< the weights whose column of G is not zero, ascending
    std::vector<double>        coupling; ///< their columns, one after the other
    dealii::FullMatrix<double> H;        ///< k x k
    dealii::FullMatrix<double> N;        ///< m x k
    std::vector<double>        lower;    ///< dw_i >= lower_i; empty: no bounds
  };

  struct BorderedVector
  {
    std::vector<double> positions;   ///< free degrees of freedom
    std::vector<double> weights;     ///< k
    std::vector<double> multipliers; ///< m
  };

  /// Solves the bordered system of a step.
  class BorderedSolver
  {
  public:
    virtual ~BorderedSolver() = default;

    /// As Solver/Linear solver names it.
    virtual std::string
    name() const = 0;

    /// The values of A on the pattern, to be overwritten.
    virtual std::vector<double> &
    matrix_values()
        = 0;

    /// A and its factor; null if they are none of their own.
    virtual SpdOperator *
    matrix()
        = 0;

    /// The last Schur complement H - G^T Z; empty if there was none.
    virtual const dealii::FullMatrix<double> &
    schur_complement() const
    {
      static const dealii::FullMatrix<double> none;
      return none;
    }

    /// Where the nodes are in the state of which A is the tangent; see SpdOperator.
    virtual void
    place_nodes(const dealii::Vector<double> & /*positions*/)
    {
    }

    /// Prepare for solve() with A as it is now. Throws SolverFailure if A is not
    /// positive definite.
    virtual void
    factorize(const WeightBlock &block)
        = 0;

    /// The right side is overwritten by the solution. Until the next factorize() the
    /// coupling must stay as it is. Throws SolverFailure if the system is singular.
    virtual void
    solve(const WeightBlock &block, BorderedVector &right_side)
        = 0;
  };

  /// Block elimination: one call for A^-1 [r_x, G], then the dense Schur complement
  /// H - G^T A^-1 G bordered by N.
  std::unique_ptr<BorderedSolver>
  make_block_solver(std::unique_ptr<SpdOperator> matrix, const SymmetricPattern &pattern);

  /// The same with a matrix that has its pattern.
  std::unique_ptr<BorderedSolver>
  make_block_solver(std::unique_ptr<SpdOperator> matrix);

  /// The whole bordered matrix at once by UMFPACK; for checking.
  std::unique_ptr<BorderedSolver>
  make_umfpack_solver(const SymmetricPattern &pattern);
} // namespace Exemplar

#endif
