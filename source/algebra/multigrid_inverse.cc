// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/chebyshev.h>
#include <exemplar/algebra/lanczos.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/multigrid_inverse.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    // chosen by measurement, doc/measured.md
    constexpr double       cycles_leave   = 0.3; ///< greatest remaining part of the error
    constexpr unsigned int max_cycles     = 10;
    constexpr double       cycle_is_above = 1.05; ///< safety factor of Lanczos' estimate

    /// Least number of steps of Chebyshev's iteration that reduce the error to cycles_leave.
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
  } // namespace

  MultigridInverse::MultigridInverse(std::shared_ptr<MultigridCycle> new_cycle,
                                     const std::vector<int>         &row_of,
                                     const Exchange                 &exchange)
      : exchange(exchange), row_of(row_of), cycle(std::move(new_cycle)),
        right_side(cycle->matrix().zeros()), step(right_side)
  {
    const auto by_cycle = [this](const BlockVector &residual) -> const BlockVector &
    { return cycle->apply(residual, CycleShape::V); };
    spectrum = find_eigenvalues(cycle->matrix(), by_cycle, exchange);
    spectrum.second *= cycle_is_above;
    n_cycles = find_n_cycles(spectrum.second / spectrum.first);
    count_operations();
  }

  void
  MultigridInverse::count_operations()
  {
    // cost in nanoseconds on the machine of doc/measured.md; only ratios matter
    std::vector<double> counts{ static_cast<double>(row_of.size()),
                                static_cast<double>(cycle->matrix().n_blocks()),
                                cycle->n_blocks() };
    exchange.sum(counts);
    const double iteration  = 60. * counts[0] + 2.6 * n_cycles * (counts[1] + counts[2]);
    relative_cost           = 2000. * counts[1] / iteration;
    relative_cost_of_column = 1100. * counts[1] / iteration; // conjugate gradients to 1e-8
  }

  void
  MultigridInverse::solve(BlockVector &result)
  {
    const BlockVector of_all = right_side;
    ChebyshevFactors  factors(spectrum.first, spectrum.second);
    std::fill(step.begin(), step.end(), 0.F);
    result = step;
    for (unsigned int k = 0; k < n_cycles; ++k)
    {
      if (k > 0)
        cycle->matrix().find_residual(of_all, result, right_side);
      const BlockVector &solution = cycle->apply(right_side, CycleShape::V);
      const auto keep = static_cast<float>(factors.keep), take = static_cast<float>(factors.take);
      for (std::size_t i = 0; i < 4 * cycle->matrix().n_rows(); ++i)
      {
        step[i] = keep * step[i] + take * solution[i];
        result[i] += step[i];
      }
      factors.advance();
    }
  }

  void
  MultigridInverse::apply(std::vector<double> &vector)
  {
    // scaled: forces that shrink by ten orders of magnitude would underflow in single precision
    const double scale = exchange.max(max_entry(vector));
    if (scale == 0.)
      return;
    const auto place = [](const int row) { return 4 * (row / 3) + row % 3; };
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
    return sizeof(int) * row_of.capacity() + cycle->memory_consumption()
           + sizeof(float) * (right_side.capacity() + step.capacity());
  }
} // namespace Exemplar
