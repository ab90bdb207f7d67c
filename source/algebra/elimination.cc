// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/elimination.h>
#include <exemplar/base/loop_parts.h>

#include <algorithm>
#include <cstring>

namespace Exemplar
{
  namespace
  {
    // Fronts are cut into blocks of these sizes whatever the number of threads.

    constexpr int            rows_of_task   = 256; ///< a multiple of slab_rows
    constexpr std::ptrdiff_t blocks_at_once = 4;   ///< whose rows of a task the second cache holds

    constexpr int columns_of_task = 16;

    constexpr std::size_t entries_ahead = 32; ///< to be fetched from memory

    /// Number of threads for n tasks of so many operations each: starting a thread takes as long as
    /// some ten thousand operations.
    int
    threads_for(const int n_threads, const int n, const double operations)
    {
      return n * operations < 2e5 ? 1 : std::min(n_threads, n);
    }

    int
    n_tasks(const int n, const int size)
    {
      return (n + size - 1) / size;
    }
  } // namespace

  template <typename Number>
  Elimination<Number>::Elimination(const FactorStructure     &structure,
                                   const std::vector<double> &entries,
                                   const double               scale,
                                   Number                    *panels)
      : structure(structure), entries(entries), scale(scale), panels(panels),
        kernels(front_kernels<Number>()), squares(structure.n_supernodes())
  {
  }

  template <typename Number>
  bool
  Elimination<Number>::run(const int n_threads)
  {
    const int n = static_cast<int>(structure.subtrees.size());
    for_each_task(n, n_threads,
                  [&](const int i, int /*thread*/)
                  {
                    const FactorStructure::Subtree &subtree = structure.subtrees[i];
                    for (int s = subtree.begin; s < subtree.end && is_definite; ++s)
                      eliminate(s, 1);
                  });
    for (const int s : structure.top)
      if (is_definite)
        eliminate(s, n_threads);
    return is_definite;
  }

  template <typename Number>
  void
  Elimination<Number>::eliminate(const int s, const int n_threads)
  {
    const int n = structure.n_columns(s), n_rows = structure.n_rows(s);
    Number   *panel = panels + structure.first_value[s];
    gather_entries(s);
    std::vector<Columns> columns; // from the first row of the next block on
    for (PanelBlock block = PanelBlock::first(n, n_rows);; block = block.next())
    {
      for (const int child : structure.children[s])
        add_to_block(child, s, block, n_threads);
      if (!factorize_block(block, columns, panel, n_threads))
      {
        is_definite = false;
        return;
      }
      for (Columns &before : columns)
        before.values += static_cast<std::ptrdiff_t>(block.width) * before.width;
      columns.push_back({ panel + block.below(), block.width });
      if (block.column + block.width == n)
        break;
    }
    if (structure.n_below(s) > 0)
      make_square(s, columns, n_threads);
    for (const int child : structure.children[s])
    {
      add_to_square(child, s, n_threads);
      squares[child].reset();
    }
  }

  template <typename Number>
  void
  Elimination<Number>::gather_entries(const int s)
  {
    Number *to = panels + structure.first_value[s];
    std::memset(to, 0, sizeof(Number) * (structure.first_value[s + 1] - structure.first_value[s]));
    for (std::size_t e = structure.first_entries[s]; e < structure.first_entries[s + 1]; ++e)
    {
      const auto [begin, place, stride, number] = structure.entries[e];
      if (e + entries_ahead < structure.entries.size()) // they are anywhere
        __builtin_prefetch(entries.data() + structure.entries[e + entries_ahead].begin);
      for (int i = 0; i < number; ++i)
        to[place + i * stride] = static_cast<Number>(scale * entries[begin + i]);
    }
  }

  template <typename Number>
  template <typename PlaceOf>
  void
  Elimination<Number>::add_columns(const int      child,
                                   const int      begin,
                                   const int      end,
                                   const int      first_column,
                                   const PlaceOf &place_of) const
  {
    const auto    n    = static_cast<std::ptrdiff_t>(structure.n_below(child));
    const int    *rows = structure.rows_in_parent(child);
    const Number *from = squares[child].get();
    int           i    = 0, end_of_run;
    for (std::size_t r = structure.first_run[child]; r < structure.first_run[child + 1];
         ++r, i = end_of_run)
    {
      end_of_run = i + structure.runs[r].length;
      for (int first = std::max(i, begin); first < end_of_run;)
      {
        const Place place = place_of(rows[first]);
        const int   last  = std::min(end_of_run, first + place.n_rows);
        // one column of the triangle after the other where the diagonal is among these rows
        const int n_whole = std::min(end, first + 1) - begin;
        kernels.add_rows(from + begin * n + first, n, rows + begin, n_whole, first_column,
                         last - first, place.values, place.column_stride);
        for (int j = first + 1; j < std::min(end, last); ++j)
          kernels.add_rows(from + j * n + j, n, rows + j, 1, first_column, last - j,
                           place.values + j - first, place.column_stride);
        first = last;
      }
    }
  }

  template <typename Number>
  void
  Elimination<Number>::add_to_block(const int         child,
                                    const int         s,
                                    const PanelBlock &block,
                                    const int         n_threads)
  {
    const int  n = structure.n_below(child), *rows = structure.rows_in_parent(child);
    const auto index_of = [&](const int row)
    { return static_cast<int>(std::lower_bound(rows, rows + n, row) - rows); };
    const int  begin = index_of(block.column), end = index_of(block.column + block.width);
    Number    *panel    = panels + structure.first_value[s];
    const auto place_of = [&](const int row_of_supernode)
    {
      const int row = row_of_supernode - block.column, below = row - block.width;
      if (below < 0)
      {
        const int first = row / slab_rows * slab_rows, height = block.slab_height(first);
        return Place{ panel + block.begin + PanelBlock::lower_slab(first) + row - first, height,
                      first + height - row };
      }
      const int first  = below / slab_rows * slab_rows,
                height = std::min(slab_rows, block.n_below - first);
      return Place{ panel + block.below() + static_cast<std::size_t>(first) * block.width + below
                        - first,
                    height, first + height - below };
    };
    const int tasks = n_tasks(end - begin, columns_of_task);
    for_each_task(tasks, threads_for(n_threads, tasks, 8. * columns_of_task * n),
                  [&](const int t, int /*thread*/)
                  {
                    const int first = begin + t * columns_of_task;
                    add_columns(child, first, std::min(end, first + columns_of_task), block.column,
                                place_of);
                  });
  }

  template <typename Number>
  void
  Elimination<Number>::add_to_square(const int child, const int s, const int n_threads)
  {
    const int  n = structure.n_below(child), *rows = structure.rows_in_parent(child);
    const int  n_columns = structure.n_columns(s), n_below = structure.n_below(s);
    const auto begin    = static_cast<int>(std::lower_bound(rows, rows + n, n_columns) - rows);
    const auto place_of = [&, square = squares[s].get()](const int row) {
      return Place{ square + row - n_columns, n_below, slab_rows };
    };
    const int tasks = n_tasks(n - begin, columns_of_task);
    for_each_task(tasks, threads_for(n_threads, tasks, 8. * columns_of_task * n),
                  [&](const int t, int /*thread*/)
                  {
                    const int first = begin + t * columns_of_task;
                    add_columns(child, first, std::min(n, first + columns_of_task), n_columns,
                                place_of);
                  });
  }

  template <typename Number>
  void
  Elimination<Number>::subtract_products(const std::vector<Columns> &blocks,
                                         const int                   n_rows,
                                         const int                   begin,
                                         const int                   end,
                                         const int                   n_columns,
                                         const SlabTarget<Number>   &C,
                                         const bool                  overwrite) const
  {
    const auto n = static_cast<std::ptrdiff_t>(blocks.size());
    for (std::ptrdiff_t b = 0; b < n; b += blocks_at_once)
      kernels.subtract_products(blocks.data() + b,
                                static_cast<int>(std::min(blocks_at_once, n - b)), n_rows, begin,
                                end, n_columns, C, overwrite && b == 0);
  }

  template <typename Number>
  bool
  Elimination<Number>::factorize_block(const PanelBlock           &block,
                                       const std::vector<Columns> &before,
                                       Number                     *panel,
                                       const int                   n_threads)
  {
    constexpr int      stride = PanelBlock::max_width;
    alignas(64) Number triangle[stride * stride];
    for (int row = 0; row < block.width; row += slab_rows)
    {
      const int     h    = block.slab_height(row);
      const Number *slab = panel + block.begin + PanelBlock::lower_slab(row);
      for (int k = 0; k < row + h; ++k)
        std::copy(slab + k * h, slab + (k + 1) * h, triangle + k * stride + row);
    }
    const int n_rows = block.width + block.n_below;
    subtract_products(before, n_rows, 0, block.width, block.width,
                      { triangle, slab_rows, stride, stride }, false);
    if (!kernels.factorize_triangle(triangle, block.width))
      return false;
    kernels.write_inverse(triangle, block, panel);
    const std::ptrdiff_t slab_stride = slab_rows * static_cast<std::ptrdiff_t>(block.width);
    const int            tasks       = n_tasks(block.n_below, rows_of_task);
    const int            n_before    = block.column;
    for_each_task(
        tasks,
        threads_for(n_threads, tasks,
                    2. * rows_of_task * block.width * (n_before + block.width / 2)),
        [&](const int t, int /*thread*/)
        {
          const int begin = t * rows_of_task, end = std::min(block.n_below, begin + rows_of_task);
          subtract_products(before, n_rows, block.width + begin, block.width + end, block.width,
                            { panel + block.below() - block.width / slab_rows * slab_stride,
                              slab_stride, slab_rows, block.n_below % slab_rows },
                            false);
          kernels.finish_rows(block, begin, end, panel);
        });
    return true;
  }

  template <typename Number>
  void
  Elimination<Number>::make_square(const int                   s,
                                   const std::vector<Columns> &columns,
                                   const int                   n_threads)
  {
    const int n = structure.n_below(s);
    squares[s].reset(new Number[static_cast<std::size_t>(n) * n + FrontKernels<Number>::max_lanes]);
    Number   *square = squares[s].get();
    const int tasks  = n_tasks(n, rows_of_task);
    for_each_task(
        tasks, threads_for(n_threads, tasks, 1. * rows_of_task * n * structure.n_columns(s)),
        [&](const int t, int /*thread*/)
        {
          const int begin = t * rows_of_task, end = std::min(n, begin + rows_of_task);
          subtract_products(columns, n, begin, end, end, { square, slab_rows, n, n }, true);
        });
  }

  template class Elimination<double>;
  template class Elimination<float>;
} // namespace Exemplar
