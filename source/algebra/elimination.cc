// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/blas.h>
#include <exemplar/algebra/elimination.h>
#include <exemplar/base/loop_parts.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    // Fronts are cut into blocks of these sizes whatever the number of threads. BLAS, which packs
    // its operands, is faster than our kernels where operands exceed the caches.

    constexpr int great_columns = 64, great_rows = 256; ///< least size of a panel for BLAS
    constexpr int rows_of_block = 256, columns_of_square = 96;

    /// Number of threads for n tasks of so many operations each: starting a thread takes as long as
    /// some ten thousand operations.
    int
    threads_for(const int n_threads, const int n, const double operations)
    {
      return n * operations < 2e5 ? 1 : std::min(n_threads, n);
    }

    int
    n_blocks(const int n, const int size)
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
        kernels(front_kernels<Number>()), children(structure.n_supernodes()),
        squares(structure.n_supernodes())
  {
    for (int s = 0; s < structure.n_supernodes(); ++s)
      if (structure.parent[s] >= 0)
        children[structure.parent[s]].push_back(s);
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
    gather_entries(s);
    for (const int child : children[s])
      add_child(child, true, s, n_threads);
    if (!factorize_panel(s, n_threads))
    {
      is_definite = false;
      return;
    }
    if (n_below(s) > 0)
      make_square(s, n_threads);
    for (const int child : children[s])
    {
      add_child(child, false, s, n_threads);
      squares[child].reset();
    }
  }

  template <typename Number>
  void
  Elimination<Number>::gather_entries(const int s)
  {
    Number *to = panel(s);
    std::fill(to, panels + structure.first_value[s + 1], Number(0.));
    for (std::size_t e = structure.first_entry[s]; e < structure.first_entry[s + 1]; ++e)
      to[structure.place[e]] = static_cast<Number>(scale * entries[structure.entry[e]]);
  }

  template <typename Number>
  void
  Elimination<Number>::add_child(const int  child,
                                 const bool to_panel,
                                 const int  s,
                                 const int  n_threads)
  {
    const int  n = n_below(child), n_columns = structure.n_columns(s);
    const int *places = structure.place_in_parent.data() + structure.first_row[child]
                        + structure.n_columns(child);
    const auto boundary
        = static_cast<int>(std::lower_bound(places, places + n, n_columns) - places);
    const int     begin = to_panel ? 0 : boundary, end = to_panel ? boundary : n;
    const Number *from            = squares[child].get();
    Number       *to              = to_panel ? panel(s) : squares[s].get();
    const int     shift           = to_panel ? 0 : n_columns;
    const auto    stride          = static_cast<std::ptrdiff_t>(structure.n_rows(s) - shift);
    constexpr int columns_at_once = 16;
    const int     blocks          = n_blocks(end - begin, columns_at_once);
    for_each_task(blocks, threads_for(n_threads, blocks, 8. * n),
                  [&](const int b, int /*thread*/)
                  {
                    const int first = begin + b * columns_at_once;
                    for (int j = first; j < std::min(end, first + columns_at_once); ++j)
                      kernels.add_scattered(from + static_cast<std::ptrdiff_t>(j) * n + j,
                                            places + j, n - j,
                                            to + stride * (places[j] - shift) - shift);
                  });
  }

  template <typename Number>
  bool
  Elimination<Number>::factorize_panel(const int s, const int n_threads)
  {
    const int n_rows = structure.n_rows(s), n = structure.n_columns(s);
    if (n < great_columns || n_rows < great_rows)
      return kernels.factorize(panel(s), n_rows, n_rows, n);
    return factorize_great_panel(s, n_threads);
  }

  template <typename Number>
  bool
  Elimination<Number>::factorize_great_panel(const int s, const int n_threads)
  {
    const int  n_rows = structure.n_rows(s), n = structure.n_columns(s);
    Number    *L  = panel(s);
    const auto at = [&](const int row, const int column)
    { return L + static_cast<std::ptrdiff_t>(column) * n_rows + row; };
    for (int c = 0; c < n; c += great_columns)
    {
      const int m = std::min(great_columns, n - c), below = c + m;
      // update columns c to below - 1 by the columns before them
      const int blocks = n_blocks(n_rows - c, rows_of_block);
      for_each_task(blocks, threads_for(n_threads, blocks, 2e4 * c),
                    [&](const int b, int /*thread*/)
                    {
                      if (const int row = c + b * rows_of_block; c > 0)
                        Blas::subtract_product<Number>("N", "T",
                                                       std::min(rows_of_block, n_rows - row), m, c,
                                                       { at(row, 0), n_rows }, { at(c, 0), n_rows },
                                                       1., { at(row, c), n_rows });
                    });
      if (!kernels.factorize(at(c, c), n_rows, m, m))
        return false;
      const int blocks_below = n_blocks(n_rows - below, rows_of_block);
      for_each_task(blocks_below, threads_for(n_threads, blocks_below, 1e6),
                    [&](const int b, int /*thread*/)
                    {
                      const int row = below + b * rows_of_block;
                      Blas::solve_triangle<Number>("R", "T", std::min(rows_of_block, n_rows - row),
                                                   m, { at(c, c), n_rows }, { at(row, c), n_rows });
                    });
    }
    return true;
  }

  template <typename Number>
  void
  Elimination<Number>::make_square(const int s, const int n_threads)
  {
    const int  n = n_below(s), n_rows = structure.n_rows(s), n_inner = structure.n_columns(s);
    const bool is_great = n_inner >= great_columns && n >= great_rows;
    squares[s].reset(new Number[static_cast<std::size_t>(n) * n + FrontKernels<Number>::max_lanes]);
    const Number *A      = panel(s) + n_inner;
    Number       *square = squares[s].get();
    const int     blocks = n_blocks(n, columns_of_square);
    for_each_task(blocks, threads_for(n_threads, blocks, 50. * n * n_inner),
                  [&](const int b, int /*thread*/)
                  {
                    const int c = b * columns_of_square, m = std::min(columns_of_square, n - c);
                    Number   *to = square + static_cast<std::ptrdiff_t>(c) * n + c;
                    if (is_great)
                      Blas::subtract_product<Number>("N", "T", n - c, m, n_inner, { A + c, n_rows },
                                                     { A + c, n_rows }, 0., { to, n });
                    else
                      kernels.subtract_square(A + c, n_rows, n_inner, n - c, m, to, n, true);
                  });
  }

  template class Elimination<double>;
  template class Elimination<float>;
} // namespace Exemplar
