// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_single_precision_factor_loops_h
#define exemplar_single_precision_factor_loops_h

#include <exemplar/algebra/single_precision_factor.h>

#include <algorithm>

namespace Exemplar
{
  /// The triangular solves with batches of floats; see cell_kernels_loops.h for who may include this.
  template <typename Batch>
  struct TriangularLoops
  {
    static constexpr std::size_t width = Batch::size;
    static_assert(width <= FactorPanels::max_lanes);
    static constexpr int n_columns = 4; ///< that are treated at once

    // The last batch reaches beyond the rows, into what follows in memory: `values` and `block`
    // have room for it, and there the block is zero or unused.

    /// target -= sum_k y_k column_k over the rows from `row` to end - 1.
    template <int n>
    static void
    subtract_columns(const float *columns,
                     const int    stride,
                     const float (&y)[n_columns],
                     int       row,
                     const int end,
                     float    *target)
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

    /// Products of the columns with a vector over the rows from `row` to end - 1.
    template <int n>
    static void
    multiply_columns(const float *columns,
                     const int    stride,
                     int          row,
                     const int    end,
                     const float *vector,
                     float (&product)[n_columns])
    {
      Batch sum[n];
      for (int k = 0; k < n; ++k)
        sum[k] = Batch(0.f);
      for (; row < end; row += width)
      {
        const Batch x = Batch::load_unaligned(vector + row);
        for (int k = 0; k < n; ++k)
          sum[k] += Batch::load_unaligned(columns + k * stride + row) * x;
      }
      for (int k = 0; k < n; ++k)
        product[k] = sum_of_lanes(sum[k]);
    }

    static float
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
    forward_columns(const float *L, const int stride, const int c, float *x)
    {
      float y[n_columns];
      for (int k = 0; k < n; ++k)
      {
        y[k] = x[c + k];
        for (int l = 0; l < k; ++l)
          y[k] -= L[l * stride + c + k] * y[l];
        y[k] *= L[k * stride + c + k];
        x[c + k] = y[k];
      }
      subtract_columns<n>(L, stride, y, c + n, stride, x);
    }

    template <int n>
    static void
    backward_columns(const float *L, const int stride, const int c, float *x)
    {
      float product[n_columns];
      multiply_columns<n>(L, stride, c + n, stride, x, product);
      for (int k = n - 1; k >= 0; --k)
      {
        float y = x[c + k] - product[k];
        for (int l = k + 1; l < n; ++l)
          y -= L[k * stride + c + l] * x[c + l];
        x[c + k] = y * L[k * stride + c + k];
      }
    }

    static void
    forward(const FactorPanels &panels, float *vector, float *block)
    {
      const std::size_t n_blocks = panels.first_column.size() - 1;
      for (std::size_t s = 0; s < n_blocks; ++s)
      {
        const int    first = panels.first_column[s], n = panels.first_column[s + 1] - first;
        const int    n_rows = static_cast<int>(panels.first_row[s + 1] - panels.first_row[s]);
        const int   *rows   = panels.rows.data() + panels.first_row[s];
        const float *L      = panels.values.data() + panels.first_value[s];
        for (int i = 0; i < n_rows; ++i)
          block[i] = i < n ? vector[first + i] : 0.f;
        int c = 0;
        for (; c + n_columns <= n; c += n_columns)
          forward_columns<n_columns>(L + static_cast<std::size_t>(c) * n_rows, n_rows, c, block);
        for (; c < n; ++c)
          forward_columns<1>(L + static_cast<std::size_t>(c) * n_rows, n_rows, c, block);
        for (int i = 0; i < n; ++i)
          vector[first + i] = block[i];
        for (int i = n; i < n_rows; ++i)
          vector[rows[i]] += block[i];
      }
    }

    static void
    backward(const FactorPanels &panels, float *vector, float *block)
    {
      for (std::size_t s = panels.first_column.size() - 1; s-- > 0;)
      {
        const int    first = panels.first_column[s], n = panels.first_column[s + 1] - first;
        const int    n_rows = static_cast<int>(panels.first_row[s + 1] - panels.first_row[s]);
        const int   *rows   = panels.rows.data() + panels.first_row[s];
        const float *L      = panels.values.data() + panels.first_value[s];
        for (int i = 0; i < n; ++i)
          block[i] = vector[first + i];
        for (int i = n; i < n_rows; ++i)
          block[i] = vector[rows[i]];
        std::fill(block + n_rows, block + n_rows + width, 0.f);
        int c = n;
        for (; c % n_columns != 0; --c)
          backward_columns<1>(L + static_cast<std::size_t>(c - 1) * n_rows, n_rows, c - 1, block);
        for (; c > 0; c -= n_columns)
          backward_columns<n_columns>(L + static_cast<std::size_t>(c - n_columns) * n_rows, n_rows,
                                      c - n_columns, block);
        for (int i = 0; i < n; ++i)
          vector[first + i] = block[i];
      }
    }

    static TriangularKernels
    kernels()
    {
      return { forward, backward };
    }
  };
} // namespace Exemplar

#endif
