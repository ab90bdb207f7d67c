// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_triangular_loops_h
#define exemplar_triangular_loops_h

#include <exemplar/algebra/factor_structure.h>

#include <algorithm>

namespace Exemplar
{
  /// Triangular solves with SIMD batches; see cell_kernels_loops.h for who may include this.
  template <typename Batch>
  struct TriangularLoops
  {
    using Number               = typename Batch::value_type;
    static constexpr int width = Batch::size;

    // The last batch reaches beyond the rows, into what follows in memory: there the block is zero
    // or unused.

    static constexpr int n_at_once = 4; ///< columns

    /// target -= sum_k y_k column_k over the rows from `row` to end - 1.
    template <int n>
    static void
    subtract_columns(const Number *columns,
                     const int     stride,
                     const Number (&y)[n_at_once],
                     int       row,
                     const int end,
                     Number   *target)
    {
      Batch factor[n];
      for (int k = 0; k < n; ++k)
        factor[k] = Batch(y[k]);
      for (; row < end; row += width)
      {
        Batch sum = Batch::load_unaligned(target + row);
        for (int k = 0; k < n; ++k)
          sum -= factor[k] * Batch::load_unaligned(columns + k * stride + row);
        sum.store_unaligned(target + row);
      }
    }

    /// Scalar products of the columns with a vector over the rows from `row` to end - 1.
    template <int n>
    static void
    multiply_columns(const Number *columns,
                     const int     stride,
                     int           row,
                     const int     end,
                     const Number *vector,
                     Number (&product)[n_at_once])
    {
      Batch sum[n];
      for (int k = 0; k < n; ++k)
        sum[k] = Batch(Number(0.));
      for (; row < end; row += width)
      {
        const Batch x = Batch::load_unaligned(vector + row);
        for (int k = 0; k < n; ++k)
          sum[k] += Batch::load_unaligned(columns + k * stride + row) * x;
      }
      for (int k = 0; k < n; ++k)
        product[k] = sum_of_lanes(sum[k]);
    }

    static Number
    sum_of_lanes(const Batch &batch)
    {
#if XSIMD_VERSION_MAJOR < 9
      return xsimd::hadd(batch);
#else
      return xsimd::reduce_add(batch);
#endif
    }

    template <int n>
    static void
    forward_columns(
        const Number *L, const Number *inverse, const int stride, const int c, Number *x)
    {
      Number y[n_at_once];
      for (int k = 0; k < n; ++k)
      {
        y[k] = x[c + k];
        for (int l = 0; l < k; ++l)
          y[k] -= L[l * stride + c + k] * y[l];
        y[k] *= inverse[c + k];
        x[c + k] = y[k];
      }
      subtract_columns<n>(L, stride, y, c + n, stride, x);
    }

    template <int n>
    static void
    backward_columns(
        const Number *L, const Number *inverse, const int stride, const int c, Number *x)
    {
      Number product[n_at_once];
      multiply_columns<n>(L, stride, c + n, stride, x, product);
      for (int k = n - 1; k >= 0; --k)
      {
        Number y = x[c + k] - product[k];
        for (int l = k + 1; l < n; ++l)
          y -= L[k * stride + c + l] * x[c + l];
        x[c + k] = y * inverse[c + k];
      }
    }

    static void
    forward(const FactorStructure &structure,
            const Number          *values,
            const Number          *inverse_diagonal,
            const int              begin,
            const int              end,
            Number                *vector,
            Number                *block)
    {
      for (int s = begin; s < end; ++s)
      {
        const int     first = structure.first_column[s], n = structure.n_columns(s);
        const int     n_rows  = structure.n_rows(s);
        const int    *rows    = structure.rows.data() + structure.first_row[s];
        const Number *L       = values + structure.first_value[s];
        const Number *inverse = inverse_diagonal + first;
        for (int i = 0; i < n_rows; ++i)
          block[i] = i < n ? vector[first + i] : Number(0.);
        int c = 0;
        for (; c + n_at_once <= n; c += n_at_once)
          forward_columns<n_at_once>(L + static_cast<std::size_t>(c) * n_rows, inverse, n_rows, c,
                                     block);
        for (; c < n; ++c)
          forward_columns<1>(L + static_cast<std::size_t>(c) * n_rows, inverse, n_rows, c, block);
        std::copy(block, block + n, vector + first);
        for (int i = n; i < n_rows; ++i)
          vector[rows[i]] += block[i];
      }
    }

    static void
    backward(const FactorStructure &structure,
             const Number          *values,
             const Number          *inverse_diagonal,
             const int              begin,
             const int              end,
             Number                *vector,
             Number                *block)
    {
      for (int s = end; s-- > begin;)
      {
        const int     first = structure.first_column[s], n = structure.n_columns(s);
        const int     n_rows  = structure.n_rows(s);
        const int    *rows    = structure.rows.data() + structure.first_row[s];
        const Number *L       = values + structure.first_value[s];
        const Number *inverse = inverse_diagonal + first;
        std::copy(vector + first, vector + first + n, block);
        for (int i = n; i < n_rows; ++i)
          block[i] = vector[rows[i]];
        std::fill(block + n_rows, block + n_rows + width, Number(0.));
        int c = n;
        for (; c % n_at_once != 0; --c)
          backward_columns<1>(L + static_cast<std::size_t>(c - 1) * n_rows, inverse, n_rows, c - 1,
                              block);
        for (; c > 0; c -= n_at_once)
          backward_columns<n_at_once>(L + static_cast<std::size_t>(c - n_at_once) * n_rows, inverse,
                                      n_rows, c - n_at_once, block);
        std::copy(block, block + n, vector + first);
      }
    }
  };
} // namespace Exemplar

#endif
