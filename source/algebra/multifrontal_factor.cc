// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/blas.h>
#include <exemplar/algebra/elimination.h>
#include <exemplar/algebra/front_kernels.h>
#include <exemplar/algebra/multifrontal_factor.h>

#include <algorithm>
#include <cmath>
#include <omp.h>

namespace Exemplar
{
  namespace
  {
    int
    max_rows(const FactorStructure &structure)
    {
      int maximum = 0;
      for (int s = 0; s < structure.n_supernodes(); ++s)
        maximum = std::max(maximum, structure.n_rows(s));
      return maximum;
    }

    /// Numbers of a factor from which on threads are worth their start in a solve.
    constexpr std::size_t min_values_for_threads = 400000;

    /// L^-1, or L^-T, for columns of a vector by supernodes begin to end - 1, by BLAS.
    template <typename Number>
    struct SeveralColumns
    {
      const FactorStructure &structure;
      const Number          *values;
      Number                *columns;
      int                    stride, n_columns;

      void
      forward(const int begin, const int end, std::vector<Number> &block) const
      {
        for (int s = begin; s < end; ++s)
        {
          const auto [n, below, rows, L, own] = front(s);
          Blas::solve_triangle<Number>("L", "N", n, n_columns, L, own);
          block.resize(static_cast<std::size_t>(below) * n_columns);
          Blas::subtract_product<Number>("N", "N", below, n_columns, n, { L.values + n, L.stride },
                                         { own.values, stride }, 0., { block.data(), below });
          for (int k = 0; k < n_columns; ++k)
            for (int i = 0; i < below; ++i)
              at(rows[i], k) += block[static_cast<std::size_t>(k) * below + i];
        }
      }

      void
      backward(const int begin, const int end, std::vector<Number> &block) const
      {
        for (int s = end; s-- > begin;)
        {
          const auto [n, below, rows, L, own] = front(s);
          block.resize(static_cast<std::size_t>(below) * n_columns);
          for (int k = 0; k < n_columns; ++k)
            for (int i = 0; i < below; ++i)
              block[static_cast<std::size_t>(k) * below + i] = at(rows[i], k);
          Blas::subtract_product<Number>("T", "N", n, n_columns, below, { L.values + n, L.stride },
                                         { block.data(), below }, 1., own);
          Blas::solve_triangle<Number>("L", "T", n, n_columns, L, own);
        }
      }

    private:
      struct Front
      {
        int                        n, below; ///< columns, and rows below them
        const int                 *rows;     ///< below
        Blas::Matrix<const Number> L;
        Blas::Matrix<Number>       own; ///< the entries of its columns
      };

      Front
      front(const int s) const
      {
        const int n = structure.n_columns(s), n_rows = structure.n_rows(s);
        return { n,
                 n_rows - n,
                 structure.rows.data() + structure.first_row[s] + n,
                 { values + structure.first_value[s], n_rows },
                 { columns + structure.first_column[s], stride } };
      }

      Number &
      at(const int row, const int k) const
      {
        return columns[static_cast<std::size_t>(k) * stride + row];
      }
    };
  } // namespace

  template <typename Number>
  MultifrontalFactor<Number>::MultifrontalFactor(
      std::shared_ptr<const FactorStructure> new_structure, const unsigned int n_threads)
      : structure(std::move(new_structure)), n_threads(static_cast<int>(n_threads)),
        inverse_diagonal(structure->n()), blocks(n_threads)
  {
  }

  template <typename Number>
  bool
  MultifrontalFactor<Number>::factorize(const std::vector<double> &entries)
  {
    values.resize(structure->n_values() + FrontKernels<Number>::max_lanes);
    const bool is_definite = Elimination<Number>(*structure, entries, values.data()).run(n_threads);
    if (is_definite)
      finish();
    return is_definite;
  }

  template <typename Number>
  template <typename Other>
  void
  MultifrontalFactor<Number>::assign(const Other *factor_values)
  {
    values.resize(structure->n_values() + FrontKernels<Number>::max_lanes);
    std::transform(factor_values, factor_values + structure->n_values(), values.begin(),
                   [](const Other value) { return static_cast<Number>(value); });
    finish();
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::finish()
  {
    for (int s = 0; s < structure->n_supernodes(); ++s)
      for (int c = 0; c < structure->n_columns(s); ++c)
        inverse_diagonal[structure->first_column[s] + c]
            = Number(1.)
              / values[structure->first_value[s]
                       + static_cast<std::size_t>(c) * structure->n_rows(s) + c];
  }

  template <typename Number>
  double
  MultifrontalFactor<Number>::pivot_ratio() const
  {
    const auto [min, max] = std::minmax_element(inverse_diagonal.begin(), inverse_diagonal.end());
    return std::pow(static_cast<double>(*max) / static_cast<double>(*min), 2);
  }

  template <typename Number>
  template <typename Forward, typename Backward>
  void
  MultifrontalFactor<Number>::run(const std::size_t n_columns,
                                  const Forward    &forward,
                                  const Backward   &backward)
  {
    const std::size_t n = structure->n(), n_tail = structure->tail.size(), stride = n + n_tail;
    const int         n_subtrees = static_cast<int>(structure->subtrees.size());
    const int         n_at_once  = structure->n_values() < min_values_for_threads ? 1 : n_threads;
    for (std::size_t k = 0; k < n_columns; ++k)
      std::fill_n(permuted.begin() + k * stride + n, n_tail, Number(0.));
#pragma omp parallel for schedule(dynamic) num_threads(n_at_once)
    for (int i = 0; i < n_subtrees; ++i)
      forward(structure->subtrees[i].begin, structure->subtrees[i].end,
              blocks[omp_get_thread_num()]);
    for (std::size_t k = 0; k < n_columns; ++k)
      for (std::size_t i = 0; i < n_tail; ++i)
        permuted[k * stride + structure->tail[i]] += permuted[k * stride + n + i];
    for (const int s : structure->top)
      forward(s, s + 1, blocks[0]);
    for (auto s = structure->top.rbegin(); s != structure->top.rend(); ++s)
      backward(*s, *s + 1, blocks[0]);
    for (std::size_t k = 0; k < n_columns; ++k)
      for (std::size_t i = 0; i < n_tail; ++i)
        permuted[k * stride + n + i] = permuted[k * stride + structure->tail[i]];
#pragma omp parallel for schedule(dynamic) num_threads(n_at_once)
    for (int i = 0; i < n_subtrees; ++i)
      backward(structure->subtrees[i].begin, structure->subtrees[i].end,
               blocks[omp_get_thread_num()]);
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::solve(std::vector<Number> &columns)
  {
    const std::size_t n = structure->n(), n_columns = n == 0 ? 0 : columns.size() / n;
    const std::size_t stride = n + structure->tail.size();
    if (n_columns == 0)
      return;
    permuted.resize(n_columns * stride);
    for (std::size_t k = 0; k < n_columns; ++k)
      for (std::size_t i = 0; i < n; ++i)
        permuted[k * stride + i] = columns[k * n + structure->permutation[i]];
    if (n_columns == 1)
      solve_one();
    else
      solve_several(n_columns);
    for (std::size_t k = 0; k < n_columns; ++k)
      for (std::size_t i = 0; i < n; ++i)
        columns[k * n + structure->permutation[i]] = permuted[k * stride + i];
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::solve_one()
  {
    const FrontKernels<Number> &kernels = front_kernels<Number>();
    for (std::vector<Number> &block : blocks)
      block.resize(max_rows(*structure) + FrontKernels<Number>::max_lanes);
    const auto by = [&](const auto &kernel)
    {
      return [&, kernel](const int begin, const int end, std::vector<Number> &block)
      {
        kernel(*structure, values.data(), inverse_diagonal.data(), begin, end, permuted.data(),
               block.data());
      };
    };
    run(1, by(kernels.forward), by(kernels.backward));
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::solve_several(const std::size_t n_columns)
  {
    const SeveralColumns<Number> columns
        = { *structure, values.data(), permuted.data(),
            static_cast<int>(permuted.size() / n_columns), static_cast<int>(n_columns) };
    run(
        n_columns,
        [&](const int begin, const int end, std::vector<Number> &block)
        { columns.forward(begin, end, block); },
        [&](const int begin, const int end, std::vector<Number> &block)
        { columns.backward(begin, end, block); });
    permuted.resize(structure->n() + structure->tail.size());
  }

  template <typename Number>
  std::size_t
  MultifrontalFactor<Number>::memory_consumption() const
  {
    std::size_t numbers = values.capacity() + inverse_diagonal.capacity() + permuted.capacity();
    for (const std::vector<Number> &block : blocks)
      numbers += block.capacity();
    return structure->memory_consumption() + sizeof(Number) * numbers;
  }

  template class MultifrontalFactor<double>;
  template class MultifrontalFactor<float>;
  template void
  MultifrontalFactor<float>::assign(const double *);
} // namespace Exemplar
