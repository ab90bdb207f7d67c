// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/chebyshev.h>
#include <exemplar/algebra/lanczos.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/multigrid_inverse.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    // chosen by measurement, doc/speed.md
    constexpr unsigned int smoother_degree = 2;
    constexpr double       smoother_range  = 20.; ///< greatest over least eigenvalue that it damps
    constexpr double       cycles_leave    = 0.3; ///< of an error, at most
    constexpr unsigned int max_cycles      = 10;
    constexpr unsigned int n_lanczos_steps = 8;
    constexpr double greatest_is_above = 1.1, cycle_is_above = 1.05; ///< what Lanczos' method finds

    /// How many steps of Chebyshev's iteration leave little enough of an error.
    unsigned int
    find_n_cycles(const double condition)
    {
      const double root = std::sqrt(condition), rate = (root - 1.) / (root + 1.);
      unsigned int n = 1;
      for (double left = rate; n < max_cycles && 2. * left / (1. + left * left) > cycles_leave;
           left *= rate)
        ++n;
      return n;
    }

    /// The inverses of the blocks of the diagonal, by columns; of their diagonals, where they are
    /// singular, as they are where an aggregate has too few nodes to turn.
    std::vector<float>
    invert_diagonal(const BlockMatrix &matrix)
    {
      std::vector<float> inverses(9 * matrix.n_rows() + read_beyond, 0.F);
      for (std::size_t row = 0; row < matrix.n_rows(); ++row)
      {
        const float *block = matrix.block(row, row);
        if (block == nullptr)
          continue;
        dealii::Tensor<2, 3> A, inverse;
        double               product = 1.;
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

  MultigridInverse::Level::Level(MultigridLevel level)
      : MultigridLevel(std::move(level)), inverse_diagonal(invert_diagonal(matrix)),
        solution(matrix.zeros()), right_side(solution), correction(solution), residual(solution),
        coarser(prolongation.zeros())
  {
  }

  MultigridInverse::MultigridInverse(std::vector<MultigridLevel> hierarchy,
                                     const std::vector<int>     &row_of,
                                     const Exchange             &exchange)
      : exchange(exchange), row_of(row_of), levels(std::make_move_iterator(hierarchy.begin()),
                                                   std::make_move_iterator(hierarchy.end())),
        coarsest(levels.back().matrix, exchange), step(levels[0].matrix.zeros())
  {
    for (std::size_t number = 0; number + 1 < levels.size(); ++number)
    {
      Level     &level       = levels[number];
      const auto by_diagonal = [&level](const BlockVector &residual) -> const BlockVector &
      {
        multiply_by_blocks(level.inverse_diagonal, residual, 1.F, level.solution);
        return level.solution;
      };
      level.maximum = find_eigenvalues(level.matrix, by_diagonal, n_lanczos_steps, exchange).second;
    }
    const auto by_cycle = [this](const BlockVector &residual) -> const BlockVector &
    {
      levels[0].right_side = residual;
      cycle(0);
      return levels[0].solution;
    };
    spectrum = find_eigenvalues(levels[0].matrix, by_cycle, n_lanczos_steps, exchange);
    spectrum.second *= cycle_is_above;
    n_cycles = find_n_cycles(spectrum.second / spectrum.first);
    count_operations();
  }

  void
  MultigridInverse::count_operations()
  {
    // nanoseconds on the machine of doc/speed.md; only their ratio matters
    std::vector<double> counts{ static_cast<double>(row_of.size()),
                                static_cast<double>(levels[0].matrix.n_blocks()), 0. };
    for (const Level &level : levels)
      counts[2] += 2. * smoother_degree * static_cast<double>(level.matrix.n_blocks())
                   + 2. * static_cast<double>(level.prolongation.n_blocks());
    exchange.sum(counts);
    const double iteration  = 60. * counts[0] + 2.6 * n_cycles * (counts[1] + counts[2]);
    relative_cost           = 2000. * counts[1] / iteration;
    relative_cost_of_column = 1100. * counts[1] / iteration; // by conjugate gradients to 1e-8
  }

  void
  MultigridInverse::smooth(Level &level, const bool from_zero) const
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
  MultigridInverse::cycle(const std::size_t number)
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
    cycle(number + 1);
    std::copy(coarser.solution.begin(), coarser.solution.begin() + n, level.coarser.begin());
    level.prolongation.multiply_and_add(level.coarser, level.solution);
    smooth(level, false);
  }

  void
  MultigridInverse::solve(BlockVector &result)
  {
    Level            &finest     = levels[0];
    const BlockVector right_side = finest.right_side;
    ChebyshevFactors  factors(spectrum.first, spectrum.second);
    std::fill(step.begin(), step.end(), 0.F);
    result = step;
    for (unsigned int k = 0; k < n_cycles; ++k)
    {
      if (k > 0)
        finest.matrix.find_residual(right_side, result, finest.right_side);
      cycle(0);
      const auto keep = static_cast<float>(factors.keep), take = static_cast<float>(factors.take);
      for (std::size_t i = 0; i < 4 * finest.matrix.n_rows(); ++i)
      {
        step[i] = keep * step[i] + take * finest.solution[i];
        result[i] += step[i];
      }
      factors.advance();
    }
  }

  void
  MultigridInverse::apply(std::vector<double> &vector)
  {
    // of forces that shrink by ten orders of magnitude single precision would lose the last
    const double scale = exchange.max(max_entry(vector));
    if (scale == 0.)
      return;
    const auto   place      = [](const int row) { return 4 * (row / 3) + row % 3; };
    BlockVector &right_side = levels[0].right_side;
    std::fill(right_side.begin(), right_side.end(), 0.F);
    for (std::size_t i = 0; i < vector.size(); ++i)
      right_side[place(row_of[i])] = static_cast<float>(vector[i] / scale);
    BlockVector result;
    solve(result);
    for (std::size_t i = 0; i < vector.size(); ++i)
      vector[i] = scale * result[place(row_of[i])];
  }

  std::size_t
  MultigridInverse::memory_consumption() const
  {
    std::size_t n_floats = step.capacity();
    std::size_t bytes    = sizeof(int) * row_of.capacity() + coarsest.memory_consumption();
    for (const Level &level : levels)
    {
      bytes += level.matrix.memory_consumption() + level.prolongation.memory_consumption();
      for (const auto *vector : { &level.inverse_diagonal, &level.solution, &level.right_side,
                                  &level.correction, &level.residual, &level.coarser })
        n_floats += vector->capacity();
    }
    return bytes + sizeof(float) * n_floats;
  }
} // namespace Exemplar
