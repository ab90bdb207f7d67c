// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_front_loops_h
#define exemplar_front_loops_h

#include <exemplar/algebra/front_kernels.h>
#include <exemplar/algebra/triangular_loops.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  /// FrontKernels with SIMD batches; see cell_kernels_loops.h for who may include this.
  template <typename Batch>
  struct FrontLoops
  {
    using Number               = typename Batch::value_type;
    static constexpr int width = Batch::size;
    static constexpr int n_tile
        = sizeof(Number) * width == 64 ? 8 : 4; ///< columns of a register tile
    static constexpr int n_batch = 3;           ///< rows of a tile, in batches
    static_assert(width <= static_cast<int>(FrontKernels<Number>::max_lanes));

    /// A tile of C with n columns and m batches of rows: C - A B^T, or -A B^T.
    template <int m, int n, bool overwrite>
    static void
    tile(const Number        *A,
         const Number        *B,
         const std::ptrdiff_t stride,
         const int            n_inner,
         Number              *C,
         const std::ptrdiff_t stride_of_C)
    {
      Batch sum[n][m];
      for (int c = 0; c < n; ++c)
        for (int r = 0; r < m; ++r)
          sum[c][r] = overwrite ? Batch(Number(0.))
                                : Batch::load_unaligned(C + c * stride_of_C + r * width);
      for (int k = 0; k < n_inner; ++k, A += stride, B += stride)
      {
        Batch a[m];
        for (int r = 0; r < m; ++r)
          a[r] = Batch::load_unaligned(A + r * width);
        for (int c = 0; c < n; ++c)
          for (int r = 0; r < m; ++r)
            sum[c][r] = xsimd::fnma(a[r], Batch(B[c]), sum[c][r]);
      }
      for (int c = 0; c < n; ++c)
        for (int r = 0; r < m; ++r)
          sum[c][r].store_unaligned(C + c * stride_of_C + r * width);
    }

    /// tile() for fewer than `width` rows.
    template <int n, bool overwrite>
    static void
    last_rows(const Number        *A,
              const Number        *B,
              const std::ptrdiff_t stride,
              const int            n_inner,
              const int            n_rows,
              Number              *C,
              const std::ptrdiff_t stride_of_C)
    {
      Number result[n * width];
      tile<1, n, true>(A, B, stride, n_inner, result, width);
      for (int c = 0; c < n; ++c)
        for (int r = 0; r < n_rows; ++r)
          C[c * stride_of_C + r]
              = (overwrite ? Number(0.) : C[c * stride_of_C + r]) + result[c * width + r];
    }

    template <int n, bool overwrite>
    static void
    columns(const Number        *A,
            const std::ptrdiff_t stride,
            const int            n_inner,
            const int            n_rows,
            Number              *C,
            const std::ptrdiff_t stride_of_C)
    {
      int r = 0;
      for (; r + n_batch * width <= n_rows; r += n_batch * width)
        tile<n_batch, n, overwrite>(A + r, A, stride, n_inner, C + r, stride_of_C);
      for (; r + width <= n_rows; r += width)
        tile<1, n, overwrite>(A + r, A, stride, n_inner, C + r, stride_of_C);
      if (r < n_rows)
        last_rows<n, overwrite>(A + r, A, stride, n_inner, n_rows - r, C + r, stride_of_C);
    }

    template <bool overwrite>
    static void
    subtract(const Number        *A,
             const std::ptrdiff_t stride,
             const int            n_inner,
             const int            n_rows,
             const int            n_columns,
             Number              *C,
             const std::ptrdiff_t stride_of_C)
    {
      const auto at = [&](const int c) { return C + c * stride_of_C + c; };
      int        c  = 0;
      for (; c + n_tile <= n_columns; c += n_tile)
        columns<n_tile, overwrite>(A + c, stride, n_inner, n_rows - c, at(c), stride_of_C);
      for (; c + 3 <= n_columns; c += 3) // a node's three
        columns<3, overwrite>(A + c, stride, n_inner, n_rows - c, at(c), stride_of_C);
      for (; c < n_columns; ++c)
        columns<1, overwrite>(A + c, stride, n_inner, n_rows - c, at(c), stride_of_C);
    }

    static void
    subtract_square(const Number        *A,
                    const std::ptrdiff_t stride,
                    const int            n_inner,
                    const int            n_rows,
                    const int            n_columns,
                    Number              *C,
                    const std::ptrdiff_t stride_of_C,
                    const bool           overwrite)
    {
      if (overwrite)
        subtract<true>(A, stride, n_inner, n_rows, n_columns, C, stride_of_C);
      else
        subtract<false>(A, stride, n_inner, n_rows, n_columns, C, stride_of_C);
    }

    /// target[i] -= factor * column[i].
    static void
    subtract_column(const Number *column, const Number factor, const int n, Number *target)
    {
      const Batch f(factor);
      int         i = 0;
      for (; i + width <= n; i += width)
        xsimd::fnma(f, Batch::load_unaligned(column + i), Batch::load_unaligned(target + i))
            .store_unaligned(target + i);
      for (; i < n; ++i)
        target[i] -= factor * column[i];
    }

    static void
    scale(const Number factor, const int n, Number *column)
    {
      const Batch f(factor);
      int         i = 0;
      for (; i + width <= n; i += width)
        (f * Batch::load_unaligned(column + i)).store_unaligned(column + i);
      for (; i < n; ++i)
        column[i] *= factor;
    }

    static bool
    factorize_few_columns(Number              *panel,
                          const std::ptrdiff_t stride,
                          const int            n_rows,
                          const int            n_columns)
    {
      for (int c = 0; c < n_columns; ++c)
      {
        Number *column = panel + c * stride;
        if (!(column[c] > Number(0.)))
          return false;
        column[c] = std::sqrt(column[c]);
        scale(Number(1.) / column[c], n_rows - c - 1, column + c + 1);
        for (int j = c + 1; j < n_columns; ++j)
          subtract_column(column + j, column[j], n_rows - j, panel + j * stride + j);
      }
      return true;
    }

    static bool
    factorize(Number *panel, const std::ptrdiff_t stride, const int n_rows, const int n_columns)
    {
      for (int c = 0; c < n_columns; c += n_tile)
      {
        const int n      = std::min(n_tile, n_columns - c);
        Number   *corner = panel + c * stride + c;
        subtract<false>(panel + c, stride, c, n_rows - c, n, corner, stride);
        if (!factorize_few_columns(corner, stride, n_rows - c, n))
          return false;
      }
      return true;
    }

    static void
    add_scattered(const Number *column, const int *places, const int n, Number *target)
    {
      for (int i = 0; i < n;)
        if (i + width <= n && places[i + width - 1] - places[i] == width - 1)
        {
          Number *to = target + places[i];
          (Batch::load_unaligned(to) + Batch::load_unaligned(column + i)).store_unaligned(to);
          i += width;
        }
        else
        {
          target[places[i]] += column[i];
          ++i;
        }
    }

    static FrontKernels<Number>
    kernels()
    {
      using Solves = TriangularLoops<Batch>;
      return { factorize, subtract_square, add_scattered, Solves::forward, Solves::backward };
    }
  };
} // namespace Exemplar

#endif
