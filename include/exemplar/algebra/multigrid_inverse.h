// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_inverse_h
#define exemplar_multigrid_inverse_h

#include <exemplar/algebra/block_matrix.h>
#include <exemplar/algebra/exchange.h>
#include <exemplar/algebra/kept_inverse.h>

#include <utility>
#include <vector>

struct ML_Struct;

namespace Exemplar
{
  /// A multigrid hierarchy as an approximate inverse: a copy of ML's matrices and prolongations in
  /// single precision. A number of V cycles is accelerated by Chebyshev's iteration, so that they
  /// are one symmetric positive definite operation, which conjugate gradients are not.
  class MultigridInverse : public KeptInverse
  {
  public:
    /// Of the hierarchy `ml`; `row_of` are the rows of the unknowns in its finest matrix. All
    /// processes of `exchange`, which must outlive this, have a part of both.
    MultigridInverse(const ML_Struct &ml, const std::vector<int> &row_of, const Exchange &exchange);

    void
    apply(std::vector<double> &vector) override;

    double
    cost_in_iterations(const std::size_t n_columns) const override
    {
      return relative_cost + static_cast<double>(n_columns) * relative_cost_of_column;
    }

    std::size_t
    memory_consumption() const override;

  private:
    /// The matrix of one level, the way to it from the next coarser one, and what a cycle computes
    /// on it.
    struct Level
    {
      Level(BlockMatrix matrix, BlockMatrix prolongation)
          : matrix(std::move(matrix)), prolongation(std::move(prolongation))
      {
      }

      BlockMatrix        matrix, prolongation; ///< from the next level; none on the coarsest
      std::vector<float> inverse_diagonal;     ///< 9 numbers a block, by columns
      double             greatest = 0.;        ///< eigenvalue of the matrix over its diagonal
      BlockVector        solution, right_side, correction, residual;
      BlockVector        coarser; ///< by columns of the prolongation
    };

    /// Multiply by about the inverse of the matrix, from right_side to solution of a level.
    void
    cycle(std::size_t number);

    void
    smooth(Level &level, bool from_zero) const;

    void
    invert_coarsest();

    void
    solve_coarsest();

    /// From right_side of the finest level, which is lost, to `result`.
    void
    solve(BlockVector &result);

    double
    dot(const BlockVector &a, const BlockVector &b, std::size_t n_blocks) const;

    /// The least and the greatest of the matrix of a level, preconditioned by what leads from its
    /// right_side to its solution.
    template <typename Precondition>
    std::pair<double, double>
    find_eigenvalues(Level &level, unsigned int n_steps, const Precondition &precondition) const;

    void
    count_operations();

    const Exchange           &exchange;
    const std::vector<int>    row_of;
    std::vector<Level>        levels;          ///< the finest first
    std::vector<int>          coarsest_firsts; ///< row of each process, and number of all
    std::vector<float>        coarsest;        ///< own rows of the inverse of its matrix
    std::pair<double, double> spectrum;        ///< of the finest matrix, preconditioned by a cycle
    unsigned int              n_cycles = 0;
    BlockVector               step; ///< of the polynomial
    double                    relative_cost = 0., relative_cost_of_column = 0.;
  };
} // namespace Exemplar

#endif
