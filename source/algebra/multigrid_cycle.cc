// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/chebyshev.h>
#include <exemplar/algebra/lanczos.h>
#include <exemplar/algebra/multigrid_cycle.h>

#include <deal.II/base/tensor.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    // chosen by measurement, doc/measured.md
    constexpr unsigned int smoother_degree = 2;
    constexpr double       smoother_range  = 20.; ///< ratio of greatest to least damped eigenvalue
    constexpr double       greatest_is_above = 1.1; ///< safety factor of Lanczos' estimate

    /// Inverses of the diagonal blocks, by columns; of a singular block, those of its diagonal
    /// entries. Blocks are singular where an aggregate has too few nodes to rotate.
    std::vector<float>
    invert_diagonal(const BlockMatrix &matrix)
    {
      std::vector<float> inverses(9 * matrix.n_rows() + read_beyond, 0.F);
      for (std::size_t row = 0; row < matrix.n_rows(); ++row)
      {
        const std::array<float, 9> block = matrix.diagonal_block(row);
        dealii::Tensor<2, 3>       A, inverse;
        double                     product = 1.;
        for (unsigned int i = 0; i < 3; ++i)
        {
          product *= std::max<double>(block[4 * i], 0.);
          inverse[i][i] = block[4 * i] > 0. ? 1. / block[4 * i] : 0.;
          for (unsigned int j = 0; j < 3; ++j)
            A[i][j] = 0.5 * (block[3 * j + i] + block[3 * i + j]);
        }
        if (dealii::determinant(A) > 1e-5 * product)
          inverse = dealii::invert(A);
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            inverses[9 * row + 3 * j + i] = static_cast<float>(inverse[i][j]);
      }
      return inverses;
    }
  } // namespace

  MultigridCycle::Level::Level(MultigridLevel level)
      : MultigridLevel(std::move(level)), inverse_diagonal(invert_diagonal(matrix)),
        solution(matrix.zeros()), right_side(solution), correction(solution), residual(solution),
        coarser(prolongation.zeros())
  {
  }

  MultigridCycle::MultigridCycle(std::vector<MultigridLevel> hierarchy, const Exchange &exchange)
      : levels(std::make_move_iterator(hierarchy.begin()),
               std::make_move_iterator(hierarchy.end())),
        coarsest(levels.back().matrix, exchange)
  {
    for (std::size_t number = 0; number + 1 < levels.size(); ++number)
    {
      Level     &level       = levels[number];
      const auto by_diagonal = [&level](const BlockVector &residual) -> const BlockVector &
      {
        multiply_by_blocks(level.inverse_diagonal, residual, 1.F, level.solution);
        return level.solution;
      };
      level.maximum = find_eigenvalues(level.matrix, by_diagonal, exchange).second;
    }
  }

  const BlockVector &
  MultigridCycle::apply(const BlockVector &residual, const CycleShape shape)
  {
    levels[0].right_side = residual;
    cycle(0, shape);
    return levels[0].solution;
  }

  double
  MultigridCycle::n_blocks() const
  {
    std::size_t n = 0;
    for (const Level &level : levels)
      n += 2 * smoother_degree * level.matrix.n_blocks() + 2 * level.prolongation.n_blocks();
    return static_cast<double>(n);
  }

  void
  MultigridCycle::smooth(Level &level, const bool from_zero) const
  {
    const double     maximum = greatest_is_above * level.maximum;
    ChebyshevFactors factors(maximum / smoother_range, maximum);
    for (unsigned int k = 0; k < smoother_degree; ++k)
    {
      const auto keep = static_cast<float>(factors.keep), take = static_cast<float>(factors.take);
      if (k == 0 && from_zero)
      {
        multiply_by_blocks(level.inverse_diagonal, level.right_side, take, level.correction);
        std::copy(level.correction.begin(), level.correction.end(), level.solution.begin());
      }
      else
        level.matrix.correct(level.inverse_diagonal, level.right_side, keep, take, level.solution,
                             level.correction);
      factors.advance();
    }
  }

  void
  MultigridCycle::cycle(const std::size_t number, const CycleShape shape)
  {
    if (number + 1 == levels.size())
    {
      coarsest.solve(levels[number].right_side, levels[number].solution);
      return;
    }
    Level &level = levels[number], &coarser = levels[number + 1];
    smooth(level, true);
    level.matrix.find_residual(level.right_side, level.solution, level.residual);
    level.prolongation.multiply_transposed(level.residual, level.coarser);
    const std::size_t n = 4 * coarser.matrix.n_rows();
    std::copy(level.coarser.begin(), level.coarser.begin() + n, coarser.right_side.begin());
    visit(number + 1, shape);
    std::copy(coarser.solution.begin(), coarser.solution.begin() + n, level.coarser.begin());
    level.prolongation.multiply_and_add(level.coarser, level.solution);
    smooth(level, false);
  }

  void
  MultigridCycle::visit(const std::size_t number, const CycleShape shape)
  {
    cycle(number, shape);
    if (shape == CycleShape::V || number + 1 == levels.size())
      return;
    Level            &level      = levels[number];
    const BlockVector right_side = level.right_side, first = level.solution;
    level.matrix.find_residual(right_side, level.solution, level.right_side);
    cycle(number, shape);
    for (std::size_t i = 0; i < 4 * level.matrix.n_rows(); ++i)
      level.solution[i] += first[i];
  }

  std::size_t
  MultigridCycle::memory_consumption() const
  {
    std::size_t bytes = coarsest.memory_consumption();
    for (const Level &level : levels)
    {
      bytes += level.matrix.memory_consumption() + level.prolongation.memory_consumption();
      for (const auto *vector : { &level.inverse_diagonal, &level.solution, &level.right_side,
                                  &level.correction, &level.residual, &level.coarser })
        bytes += sizeof(float) * vector->capacity();
    }
    return bytes;
  }
} // namespace Exemplar
