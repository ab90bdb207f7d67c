// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/coarsest_inverse.h>
#include <exemplar/algebra/dense.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    constexpr double min_pivot_ratio = 1e-6; ///< relative pivots below count as zero

    std::size_t
    place(const std::size_t row)
    {
      return 4 * (row / 3) + row % 3;
    }

    /// The owned rows of a matrix as dense ones, one after the other.
    std::vector<float>
    dense_rows(const BlockMatrix &matrix, const std::size_t first, const std::size_t n)
    {
      const std::size_t  n_own = 3 * matrix.n_rows();
      std::vector<float> rows(n_own * n);
      // the global numbers of ghost columns are unknown here: multiply by unit vectors
      BlockVector x = matrix.zeros(), image = matrix.zeros();
      for (std::size_t column = 0; column < n; ++column)
      {
        std::fill(x.begin(), x.end(), 0.F);
        if (column >= first && column < first + n_own)
          x[place(column - first)] = 1.F;
        matrix.multiply(x, image);
        for (std::size_t i = 0; i < n_own; ++i)
          rows[i * n + column] = image[place(i)];
      }
      return rows;
    }
  } // namespace

  CoarsestInverse::CoarsestInverse(const BlockMatrix &matrix, const Exchange &exchange)
      : exchange(exchange), firsts(first_numbers(3 * matrix.n_rows(), exchange))
  {
    const std::size_t n = firsts.back(), first = firsts[exchange.process()],
                      n_own                = 3 * matrix.n_rows();
    std::vector<std::size_t> first_entries = firsts;
    for (std::size_t &entry : first_entries)
      entry *= n;
    const std::vector<float>   all = exchange.collect(dense_rows(matrix, first, n), first_entries);
    dealii::FullMatrix<double> L(n, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        L(i, j) = all[i * n + j];
    factorize_by_cholesky(L, [](unsigned int, const double pivot, const double entry)
                          { return pivot > min_pivot_ratio * entry ? pivot : 0.; });
    inverse.resize(n_own * n);
    std::vector<double> unit(n);
    for (std::size_t i = 0; i < n_own; ++i) // symmetric: columns of the inverse are its rows
    {
      std::fill(unit.begin(), unit.end(), 0.);
      unit[first + i] = 1.;
      solve_with_factor(L, unit);
      std::copy(unit.begin(), unit.end(), &inverse[i * n]);
    }
  }

  void
  CoarsestInverse::solve(const BlockVector &right_side, BlockVector &solution) const
  {
    const unsigned int process = exchange.process();
    const std::size_t  n_own   = firsts[process + 1] - firsts[process];
    std::vector<float> own(n_own);
    for (std::size_t i = 0; i < n_own; ++i)
      own[i] = right_side[place(i)];
    const std::vector<float> all = exchange.collect(std::move(own), firsts);
    for (std::size_t i = 0; i < n_own; ++i)
    {
      float sum = 0.F;
      for (std::size_t k = 0; k < all.size(); ++k)
        sum += inverse[i * all.size() + k] * all[k];
      solution[place(i)] = sum;
    }
  }
} // namespace Exemplar
