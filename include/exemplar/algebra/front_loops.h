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
    using Number                = typename Batch::value_type;
    using Columns               = SlabColumns<Number>;
    using Target                = SlabTarget<Number>;
    static constexpr int  width = Batch::size;
    static constexpr bool is_wide
        = sizeof(Number) * width == 64;            ///< with 32 registers, otherwise 16
    static constexpr int n_tile = is_wide ? 8 : 6; ///< columns of a register tile
    /// Rows of a tile, in batches; those of single slabs.
    static constexpr int n_batch = is_wide && width == slab_rows ? 3 : 2;
    static constexpr int n_last  = std::min(n_batch, slab_rows / width);
    static constexpr int size    = PanelBlock::max_width; ///< between columns of a triangle
    static_assert(slab_rows % width == 0);

    /// Where the batch of a tile begins in slabs.
    static constexpr std::ptrdiff_t
    place(const int batch, const std::ptrdiff_t slab_stride)
    {
      return batch * width / slab_rows * slab_stride + batch * width % slab_rows;
    }

    /// sum += A B^T, where A and B are stored by columns.
    template <int m, int n>
    static void
    add_product(const Number        *A,
                const std::ptrdiff_t slab_stride,
                const std::ptrdiff_t stride_of_A,
                const Number        *B,
                const std::ptrdiff_t stride_of_B,
                const int            n_inner,
                Batch (&sum)[n][m])
    {
      for (int k = 0; k < n_inner; ++k, A += stride_of_A, B += stride_of_B)
      {
        Batch a[m];
        for (int r = 0; r < m; ++r)
          a[r] = Batch::load_unaligned(A + place(r, slab_stride));
        for (int c = 0; c < n; ++c)
          for (int r = 0; r < m; ++r)
            sum[c][r] = xsimd::fma(a[r], Batch(B[c]), sum[c][r]);
      }
    }

    template <int m, int n>
    static void
    clear(Batch (&sum)[n][m])
    {
      for (int c = 0; c < n; ++c)
        for (int r = 0; r < m; ++r)
          sum[c][r] = Batch(Number(0.));
    }

    /// Height of the slab of a row.
    static int
    height(const int row, const int n_rows)
    {
      return std::min(slab_rows, n_rows - row / slab_rows * slab_rows);
    }

    /// A tile of subtract_products() at row i and column j, of which n_stored columns are wanted.
    template <int m, int n, bool overwrite>
    static void
    tile(const Columns *blocks,
         const int      n_blocks,
         const int      n_rows,
         const int      i,
         const int      j,
         const int      n_stored,
         const Target  &C)
    {
      const int stride_of_A = height(i, n_rows), stride_of_B = height(j, n_rows);
      Batch     sum[n][m];
      clear(sum);
      for (int b = 0; b < n_blocks; ++b)
      {
        const auto at = [&](const int row)
        {
          return blocks[b].values
                 + static_cast<std::ptrdiff_t>(row / slab_rows * slab_rows) * blocks[b].width
                 + row % slab_rows;
        };
        add_product(at(i), slab_rows * blocks[b].width, stride_of_A, at(j), stride_of_B,
                    blocks[b].width, sum);
      }
      Number *slab = C.values + i / slab_rows * C.slab_stride + i % slab_rows;
      if (stride_of_A == slab_rows)
        for (int c = 0; c < n_stored; ++c)
          for (int r = 0; r < m; ++r)
          {
            Number *to = slab + (j + c) * C.column_stride + place(r, C.slab_stride);
            ((overwrite ? Batch(Number(0.)) : Batch::load_unaligned(to)) - sum[c][r])
                .store_unaligned(to);
          }
      else // the last slab, beside which something else is stored
        for (int c = 0; c < n_stored; ++c)
        {
          Number column[m * width];
          for (int r = 0; r < m; ++r)
            sum[c][r].store_unaligned(column + r * width);
          Number *to = slab + (j + c) * C.last_column_stride;
          for (int r = 0; r < std::min(m * width, n_rows - i); ++r)
            to[r] = (overwrite ? Number(0.) : to[r]) - column[r];
        }
    }

    /// n columns from j on, all rows wanted.
    template <int n, bool overwrite>
    static void
    columns(const Columns *blocks,
            const int      n_blocks,
            const int      n_rows,
            const int      begin,
            const int      end,
            const int      j,
            const int      n_stored,
            const Target  &C)
    {
      const int end_of_slabs = std::min(end, n_rows / slab_rows * slab_rows);
      int       i            = std::max(begin, j / slab_rows * slab_rows);
      for (; i + n_batch * width <= end_of_slabs; i += n_batch * width)
        tile<n_batch, n, overwrite>(blocks, n_blocks, n_rows, i, j, n_stored, C);
      for (; i < end; i += n_last * width)
        tile<n_last, n, overwrite>(blocks, n_blocks, n_rows, i, j, n_stored, C);
    }

    template <bool overwrite>
    static void
    subtract(const Columns *blocks,
             const int      n_blocks,
             const int      n_rows,
             const int      begin,
             const int      end,
             const int      n_columns,
             const Target  &C)
    {
      constexpr int n_rest = slab_rows % n_tile; // the last columns of a slab
      for (int slab = 0; slab < n_columns; slab += slab_rows)
      {
        const int n = std::min(slab_rows, n_columns - slab);
        int       j = 0;
        for (; j < n && j + n_tile <= slab_rows; j += n_tile)
          columns<n_tile, overwrite>(blocks, n_blocks, n_rows, begin, end, slab + j,
                                     std::min(n_tile, n - j), C);
        if constexpr (n_rest > 0)
          if (j < n)
            columns<n_rest, overwrite>(blocks, n_blocks, n_rows, begin, end, slab + j, n - j, C);
      }
    }

    static void
    subtract_products(const Columns *blocks,
                      const int      n_blocks,
                      const int      n_rows,
                      const int      begin,
                      const int      end,
                      const int      n_columns,
                      const Target   C,
                      const bool     overwrite)
    {
      if (overwrite)
        subtract<true>(blocks, n_blocks, n_rows, begin, end, n_columns, C);
      else
        subtract<false>(blocks, n_blocks, n_rows, begin, end, n_columns, C);
    }

    /// sum_k from `begin` to end - 1 of factor[k * size] column k of a triangle, one batch of rows.
    static Batch
    combination(const Number *columns, const Number *factors, const int begin, const int end)
    {
      Batch even(Number(0.)), odd(Number(0.));
      int   k = begin;
      for (; k + 2 <= end; k += 2)
      {
        even = xsimd::fma(Batch::load_aligned(columns + k * size), Batch(factors[k * size]), even);
        odd  = xsimd::fma(Batch::load_aligned(columns + (k + 1) * size),
                          Batch(factors[(k + 1) * size]), odd);
      }
      if (k < end)
        even = xsimd::fma(Batch::load_aligned(columns + k * size), Batch(factors[k * size]), even);
      return even + odd;
    }

    static bool
    factorize_triangle(Number *L, const int n)
    {
      for (int c = 0; c < n; ++c)
      {
        Number *column = L + c * size;
        for (int r = c / width * width; r < n; r += width)
          (Batch::load_aligned(column + r) - combination(L + r, L + c, 0, c))
              .store_aligned(column + r);
        if (!(column[c] > Number(0.)))
          return false;
        const Number root = std::sqrt(column[c]);
        const Batch  inverse(Number(1.) / root);
        for (int r = c / width * width; r < n; r += width)
          (Batch::load_aligned(column + r) * inverse).store_aligned(column + r);
        column[c] = root;
      }
      return true;
    }

    static void
    write_inverse(const Number *L, const PanelBlock &block, Number *panel)
    {
      const int n = block.width;
      // row i of the inverse is column i of this
      alignas(64) Number inverse[size * size];
      for (int i = 0; i < n; ++i)
      {
        const Number diagonal = Number(1.) / L[i * size + i];
        for (int j = 0; j <= i; j += width) // column k has zeros above its batch of row k
          (combination(inverse + j, L + i, j, i) * Batch(-diagonal))
              .store_aligned(inverse + i * size + j);
        inverse[i * size + i] = diagonal;
      }
      for (int row = 0; row < n; row += slab_rows)
      {
        const int h     = block.slab_height(row);
        Number   *lower = panel + block.begin + PanelBlock::lower_slab(row);
        for (int k = 0; k < row + h; ++k)
          for (int i = 0; i < h; ++i)
            *lower++ = k <= row + i ? inverse[(row + i) * size + k] : Number(0.);
        Number *upper = panel + block.upper() + block.upper_slab(row);
        for (int k = row; k < n; ++k)
          for (int i = 0; i < h; ++i)
            *upper++ = row + i <= k ? inverse[k * size + row + i] : Number(0.);
      }
    }

    /// n columns from j on of finish_rows(), of which n_stored are wanted.
    template <int m, int n>
    static void
    finish_tile(
        const PanelBlock &block, Number *panel, const int i, const int j, const int n_stored)
    {
      const int            row = j / slab_rows * slab_rows, h = block.slab_height(row);
      const int            stride      = height(i, block.n_below);
      const std::ptrdiff_t slab_stride = slab_rows * block.width;
      Number              *A = panel + block.below() + i / slab_rows * slab_stride + i % slab_rows;
      const Number        *B = panel + block.begin + PanelBlock::lower_slab(row) + j - row;
      Batch                sum[n][m];
      clear(sum);
      add_product(A, slab_stride, stride, B, h, std::min(j + n, row + h), sum);
      if (stride == slab_rows)
        for (int c = 0; c < n_stored; ++c)
          for (int r = 0; r < m; ++r)
            sum[c][r].store_unaligned(A + (j + c) * slab_rows + place(r, slab_stride));
      else
        for (int c = 0; c < n_stored; ++c)
        {
          Number column[m * width];
          for (int r = 0; r < m; ++r)
            sum[c][r].store_unaligned(column + r * width);
          std::copy(column, column + std::min(m * width, block.n_below - i), A + (j + c) * stride);
        }
    }

    template <int m>
    static void
    finish_rows_from(const PanelBlock &block, Number *panel, const int i)
    {
      // the last columns first, for they need those before as they were
      constexpr int n_rest = slab_rows % n_tile;
      for (int slab = (block.width - 1) / slab_rows * slab_rows; slab >= 0; slab -= slab_rows)
      {
        const int n = std::min(slab_rows, block.width - slab);
        if constexpr (n_rest > 0)
          if (n > slab_rows - n_rest)
            finish_tile<m, n_rest>(block, panel, i, slab + slab_rows - n_rest,
                                   n - (slab_rows - n_rest));
        for (int j = (slab_rows / n_tile - 1) * n_tile; j >= 0; j -= n_tile)
          if (j < n)
            finish_tile<m, n_tile>(block, panel, i, slab + j, std::min(n_tile, n - j));
      }
    }

    static void
    finish_rows(const PanelBlock &block, const int begin, const int end, Number *panel)
    {
      const int end_of_slabs = std::min(end, block.n_below / slab_rows * slab_rows);
      int       i            = begin;
      for (; i + n_batch * width <= end_of_slabs; i += n_batch * width)
        finish_rows_from<n_batch>(block, panel, i);
      for (; i < end; i += n_last * width)
        finish_rows_from<n_last>(block, panel, i);
    }

    static void
    add_rows(const Number        *from,
             const std::ptrdiff_t stride,
             const int           *column_places,
             const int            n_columns,
             const int            first_place,
             const int            n_rows,
             Number              *to,
             const std::ptrdiff_t stride_of_target)
    {
      for (int c = 0; c < n_columns; ++c, from += stride)
      {
        Number *column = to + (column_places[c] - first_place) * stride_of_target;
        int     r      = 0;
        for (; r + width <= n_rows; r += width)
          (Batch::load_unaligned(column + r) + Batch::load_unaligned(from + r))
              .store_unaligned(column + r);
        for (; r < n_rows; ++r)
          column[r] += from[r];
      }
    }

    static FrontKernels<Number>
    kernels()
    {
      using Solves = TriangularLoops<Batch>;
      return { subtract_products, factorize_triangle, write_inverse,   finish_rows,
               add_rows,          Solves::forward,    Solves::backward };
    }
  };
} // namespace Exemplar

#endif
