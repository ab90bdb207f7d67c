// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_triangular_loops_h
#define exemplar_triangular_loops_h

#include <exemplar/algebra/front_kernels.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace Exemplar
{
  /// Triangular solves with SIMD batches; see cell_kernels_loops.h for who may include this. n is the number of right sides that
  /// are solved for at once.
  template <typename Batch, int n>
  struct TriangularLoopsFor
  {
    using Number                   = typename Batch::value_type;
    using Vectors                  = SupernodeVectors<Number>;
    static constexpr int width     = Batch::size;
    static constexpr int in_slab   = slab_rows / width; ///< batches of a slab
    static constexpr int at_once   = in_slab == 1 && n <= 2   ? 4
                                     : in_slab <= 2 && n == 1 ? 2
                                                              : 1; ///< slabs
    static constexpr int max_width = PanelBlock::max_width;
    /// So far ahead what will be read is fetched from memory.
    static constexpr std::ptrdiff_t ahead = 8192 / sizeof(Number);

    /// Numbers by column of a block, for each right side.
    struct alignas(64) Own
    {
      Number of[n][max_width + slab_rows];
    };

    /// sum = A x for a slab, or several that are `slab_stride` apart, with so many columns.
    template <int slabs>
    static void
    multiply(const Number        *A,
             const std::ptrdiff_t slab_stride,
             const std::ptrdiff_t stride,
             const int            n_columns,
             const Own           &x,
             const int            first,
             Batch (&sum)[slabs * in_slab][n])
    {
      constexpr int n_sums
          = slabs * in_slab * n < 8 ? 2 : 1; // more, and fewer additions wait for each other
      Batch part[n_sums][slabs * in_slab][n];
      for (int p = 0; p < n_sums; ++p)
        for (int r = 0; r < slabs * in_slab; ++r)
          for (int c = 0; c < n; ++c)
            part[p][r][c] = Batch(Number(0.));
      const auto add = [&](const int p, const int k)
      {
        __builtin_prefetch(A + k * stride + ahead);
        for (int r = 0; r < slabs * in_slab; ++r)
        {
          const Batch a = Batch::load_unaligned(A + r / in_slab * slab_stride + r % in_slab * width
                                                + k * stride);
          for (int c = 0; c < n; ++c)
            part[p][r][c] = xsimd::fma(a, Batch(x.of[c][first + k]), part[p][r][c]);
        }
      };
      int k = 0;
      for (; k + n_sums <= n_columns; k += n_sums)
        for (int p = 0; p < n_sums; ++p)
          add(p, k + p);
      if (k < n_columns)
        add(0, k);
      for (int r = 0; r < slabs * in_slab; ++r)
        for (int c = 0; c < n; ++c)
          sum[r][c] = n_sums == 2 ? part[0][r][c] + part[n_sums - 1][r][c] : part[0][r][c];
    }

    /// x -= A y for slabs of rows.
    template <int slabs>
    static void
    subtract(const Number  *A,
             const int      stride,
             const int      n_columns,
             const Own     &y,
             Number        *x,
             const Vectors &v)
    {
      Batch sum[slabs * in_slab][n];
      multiply<slabs>(A, slab_rows * n_columns, stride, n_columns, y, 0, sum);
      for (int r = 0; r < slabs * in_slab; ++r)
        for (int c = 0; c < n; ++c)
        {
          Number *to = x + c * v.stride + r * width;
          (Batch::load_unaligned(to) - sum[r][c]).store_unaligned(to);
        }
    }

    /// Lane by lane, the products of the columns of A with a vector over slabs of rows are added to sums.
    template <int slabs>
    static void
    add_products(const Number  *A,
                 const int      stride,
                 const int      n_columns,
                 const Number  *x,
                 const Vectors &v,
                 Number        *sums)
    {
      Batch rows[n][slabs * in_slab];
      for (int c = 0; c < n; ++c)
        for (int r = 0; r < slabs * in_slab; ++r)
          rows[c][r] = Batch::load_unaligned(x + c * v.stride + r * width);
      for (int k = 0; k < n_columns; ++k, A += stride, sums += n * width)
      {
        __builtin_prefetch(A - ahead);
        Batch sum[n];
        for (int c = 0; c < n; ++c)
          sum[c] = Batch::load_aligned(sums + c * width);
        for (int r = 0; r < slabs * in_slab; ++r)
        {
          const Batch a = Batch::load_unaligned(
              A + static_cast<std::ptrdiff_t>(r / in_slab * slab_rows) * n_columns
              + r % in_slab * width);
          for (int c = 0; c < n; ++c)
            sum[c] = xsimd::fma(a, rows[c][r], sum[c]);
        }
        for (int c = 0; c < n; ++c)
          sum[c].store_aligned(sums + c * width);
      }
    }

    /// Lane by lane: a[l] + a[l ^ h] where the bit h of l is 0, otherwise b[l] + b[l ^ h].
    template <int h, std::size_t... l>
    static Batch
    fold(const Batch &a, const Batch &b, std::index_sequence<l...>)
    {
      using Register [[gnu::vector_size(sizeof(Number) * width)]] = Number;
      Register of_a, of_b;
      std::memcpy(&of_a, &a, sizeof of_a);
      std::memcpy(&of_b, &b, sizeof of_b);
      const Register sum
          = __builtin_shufflevector(of_a, of_b, (l & h ? l + width : l)...)
            + __builtin_shufflevector(of_a, of_b, (l & h ? (l ^ h) + width : l ^ h)...);
      Batch result;
      std::memcpy(&result, &sum, sizeof sum);
      return result;
    }

    /// The sums of the lanes of as many batches as a batch has lanes, `stride` apart: that of batch l is lane l.
    template <int h = 1>
    static Batch
    sums_of_lanes(const Number *batches, const int stride)
    {
      if constexpr (h == width)
        return Batch::load_aligned(batches);
      else
        return fold<h>(sums_of_lanes<2 * h>(batches, stride),
                       sums_of_lanes<2 * h>(batches + h * stride, stride),
                       std::make_index_sequence<width>());
    }

    /// The product of a triangle with x, one slab of rows after the other.
    static void
    multiply_triangle(const Number     *A,
                      const bool        is_lower,
                      const PanelBlock &block,
                      const Own        &x,
                      Number           *to,
                      const Vectors    &v)
    {
      for (int row = 0; row < block.width; row += slab_rows)
      {
        const int h     = block.slab_height(row);
        const int first = is_lower ? 0 : row, n_columns = is_lower ? row + h : block.width - row;
        Batch     sum[in_slab][n];
        multiply<1>(A, 0, h, n_columns, x, first, sum);
        for (int c = 0; c < n; ++c)
        {
          alignas(64) Number rows[slab_rows];
          for (int r = 0; r < in_slab; ++r)
            sum[r][c].store_aligned(rows + r * width);
          std::copy(rows, rows + h, to + c * v.stride + row);
        }
        A += h * n_columns;
      }
    }

    static void
    copy(const Number *from, const Vectors &v, const int size, Own &to)
    {
      for (int c = 0; c < n; ++c)
        std::copy(from + c * v.stride, from + c * v.stride + size, to.of[c]);
    }

    static void
    forward_block(const PanelBlock &block, const Number *panel, Number *x, const Vectors &v)
    {
      Own own;
      copy(x + block.column, v, block.width, own);
      multiply_triangle(panel + block.begin, true, block, own, x + block.column, v);
      copy(x + block.column, v, block.width, own);
      const Number *A     = panel + block.below();
      Number       *below = x + block.column + block.width;
      int           i     = 0;
      const auto    by    = [&](auto subtract_slabs, const int slabs)
      {
        for (; i + slabs * slab_rows <= block.n_below; i += slabs * slab_rows)
          subtract_slabs(A + static_cast<std::ptrdiff_t>(i) * block.width, slab_rows, block.width,
                         own, below + i, v);
      };
      by(subtract<at_once>, at_once);
      if constexpr (at_once == 4)
        by(subtract<2>, 2);
      by(subtract<1>, 1);
      if (i < block.n_below) // what this changes behind the last row is unused
        subtract<1>(A + static_cast<std::ptrdiff_t>(i) * block.width, block.n_below - i,
                    block.width, own, below + i, v);
    }

    static void
    backward_block(const PanelBlock &block, const Number *panel, Number *x, const Vectors &v)
    {
      alignas(64) Number sums[max_width * n * width];
      std::fill(sums, sums + (block.width + width - 1) / width * width * n * width, Number(0.));
      const Number *A     = panel + block.below();
      Number       *below = x + block.column + block.width;
      // in the order of memory, backwards
      int        i  = block.n_below / slab_rows * slab_rows;
      const auto at = [&] { return A + static_cast<std::ptrdiff_t>(i) * block.width; };
      if (i < block.n_below) // the vector is zero behind the last row
        add_products<1>(at(), block.n_below - i, block.width, below + i, v, sums);
      const auto by = [&](auto add_slabs, const int slabs, const int multiple)
      {
        while (i % (multiple * slab_rows) != 0 || (multiple == slabs && i > 0))
        {
          i -= slabs * slab_rows;
          add_slabs(at(), slab_rows, block.width, below + i, v, sums);
        }
      };
      by(add_products<1>, 1, at_once == 4 ? 2 : at_once);
      if constexpr (at_once == 4)
        by(add_products<2>, 2, 4);
      by(add_products<at_once>, at_once, at_once);
      Own own;
      for (int k = 0; k < block.width; k += width)
        for (int c = 0; c < n; ++c)
          (Batch::load_unaligned(x + c * v.stride + block.column + k)
           - sums_of_lanes(sums + (k * n + c) * width, n * width))
              .store_aligned(own.of[c] + k);
      multiply_triangle(panel + block.upper(), false, block, own, x + block.column, v);
    }

    static void
    forward(const FactorStructure &structure,
            const Number          *values,
            const int              begin,
            const int              end,
            const Vectors          v)
    {
      for (int s = begin; s < end; ++s)
      {
        const int n_columns = structure.n_columns(s);
        Number   *x         = v.values + structure.vector_begin(s);
        for (int c = 0; c < n; ++c)
        {
          std::fill_n(x + c * v.stride + n_columns, structure.n_below(s), Number(0.));
          for (const int child : structure.children[s])
            add_child(structure, child, v.values + c * v.stride, x + c * v.stride);
        }
        const Number *panel = values + structure.first_value[s];
        for (PanelBlock block = PanelBlock::first(n_columns, structure.n_rows(s));;
             block            = block.next())
        {
          forward_block(block, panel, x, v);
          if (block.column + block.width == n_columns)
            break;
        }
      }
    }

    static void
    add_child(const FactorStructure &structure, const int child, const Number *vector, Number *to)
    {
      const Number *from = vector + structure.vector_begin(child) + structure.n_columns(child);
      for (std::size_t r = structure.first_run[child]; r < structure.first_run[child + 1]; ++r)
      {
        const auto [place, length] = structure.runs[r];
        if (length == slab_rows)
          for (int i = 0; i < slab_rows; i += width)
            (Batch::load_unaligned(to + place + i) + Batch::load_unaligned(from + i))
                .store_unaligned(to + place + i);
        else
          for (int i = 0; i < length; ++i)
            to[place + i] += from[i];
        from += length;
      }
    }

    static void
    take_from_parent(const FactorStructure &structure, const int s, const Number *from, Number *to)
    {
      for (std::size_t r = structure.first_run[s]; r < structure.first_run[s + 1]; ++r)
      {
        const auto [place, length] = structure.runs[r];
        for (int i = 0; i < slab_rows; i += width) // the next run overwrites what is too much
          Batch::load_unaligned(from + place + i).store_unaligned(to + i);
        to += length;
      }
      std::fill_n(to, slab_rows, Number(0.));
    }

    static void
    backward(const FactorStructure &structure,
             const Number          *values,
             const int              begin,
             const int              end,
             const Vectors          v)
    {
      for (int s = end; s-- > begin;)
      {
        const int n_columns = structure.n_columns(s), parent = structure.parent[s];
        Number   *x = v.values + structure.vector_begin(s);
        for (int c = 0; c < n && parent >= 0; ++c)
          take_from_parent(structure, s, v.values + c * v.stride + structure.vector_begin(parent),
                           x + c * v.stride + n_columns);
        const Number *panel = values + structure.first_value[s];
        backward_blocks(PanelBlock::first(n_columns, structure.n_rows(s)), n_columns, panel, x, v);
      }
    }

    static void
    backward_blocks(const PanelBlock &block,
                    const int         n_columns,
                    const Number     *panel,
                    Number           *x,
                    const Vectors    &v)
    {
      if (block.column + block.width < n_columns)
        backward_blocks(block.next(), n_columns, panel, x, v);
      backward_block(block, panel, x, v);
    }
  };

  /// FrontKernels::forward and backward.
  template <typename Batch>
  struct TriangularLoops
  {
    using Number  = typename Batch::value_type;
    using Vectors = SupernodeVectors<Number>;

    /// Call a function with the loops for so many right sides.
    template <typename Function>
    static void
    with_number(const int number, const Function &function)
    {
      static_assert(Vectors::max_number == 4);
      if (number == 1)
        function(TriangularLoopsFor<Batch, 1>());
      else if (number == 2)
        function(TriangularLoopsFor<Batch, 2>());
      else if (number == 3)
        function(TriangularLoopsFor<Batch, 3>());
      else
        function(TriangularLoopsFor<Batch, 4>());
    }

    static void
    forward(const FactorStructure &structure,
            const Number          *values,
            const int              begin,
            const int              end,
            const Vectors          vectors)
    {
      with_number(vectors.number,
                  [&](const auto loops) { loops.forward(structure, values, begin, end, vectors); });
    }

    static void
    backward(const FactorStructure &structure,
             const Number          *values,
             const int              begin,
             const int              end,
             const Vectors          vectors)
    {
      with_number(vectors.number, [&](const auto loops)
                  { loops.backward(structure, values, begin, end, vectors); });
    }
  };
} // namespace Exemplar

#endif
