// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_factor_structure_h
#define exemplar_factor_structure_h

#include <algorithm>
#include <cstddef>
#include <vector>

// Symbolic structure of a sparse Cholesky factor. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Rows of panels stand in slabs of so many, which are stored one after the other, each by its columns: so all loops over
  /// a factor read it from one end to the other, and products of matrices need no copy of their operands. The last slab of
  /// several has as many rows as are left.
  constexpr int slab_rows = 16;

  /// Number of values, rounded up to the alignment of what begins behind them.
  constexpr std::size_t
  aligned(const std::size_t n)
  {
    return (n + slab_rows - 1) / slab_rows * slab_rows;
  }

  /// A block of columns of a supernode's panel. Stored are the inverse of its triangle of L, in slabs that end at the diagonal;
  /// the transposed inverse, in slabs that begin there; and the rows of L below the triangle, in slabs.
  struct PanelBlock
  {
    static constexpr int max_width = 64;

    int         column;  ///< the first one, counted from the supernode's
    int         width;   ///< number of columns
    int         n_below; ///< number of rows below the triangle
    std::size_t begin;   ///< in the panel

    std::size_t
    upper() const
    {
      return begin + triangle_size();
    }

    std::size_t
    below() const
    {
      return upper() + triangle_size();
    }

    std::size_t
    end() const
    {
      return below() + aligned(static_cast<std::size_t>(n_below) * width);
    }

    /// Numbers in a triangle's slabs.
    std::size_t
    triangle_size() const
    {
      return aligned(lower_slab(width / slab_rows * slab_rows)
                     + static_cast<std::size_t>(width % slab_rows) * width);
    }

    /// Begin of the slab of a triangle, or of the transposed one, whose first row is this multiple of slab_rows. It has columns
    /// 0 to row + slab_height(row) - 1, or those from `row` on.
    static std::size_t
    lower_slab(const int row)
    {
      return static_cast<std::size_t>(row) * (row + slab_rows) / 2;
    }

    std::size_t
    upper_slab(const int row) const
    {
      return static_cast<std::size_t>(row) * (2 * width - row + slab_rows) / 2;
    }

    int
    slab_height(const int row) const
    {
      return std::min(slab_rows, width - row);
    }

    /// The first block of a panel, which is as wide as needed for the others to be of the greatest width: so their rows
    /// stand in the same slabs.
    static PanelBlock
    first(const int n_columns, const int n_rows)
    {
      const int width = (n_columns - 1) % max_width + 1;
      return { 0, width, n_rows - width, 0 };
    }

    PanelBlock
    next() const
    {
      return { column + width, max_width, n_below - max_width, end() };
    }
  };

  /// The factor L of P A P^T = L L^T by supernodes, consecutive columns with the same rows below
  /// their triangle. The parent of a supernode in the elimination tree is the supernode of its first
  /// row below the triangle; children come before parents. Panels are stored as PanelBlock says.
  ///
  /// In a solve each supernode has a vector of its own, by its rows, with a slab's rows behind it.
  struct FactorStructure
  {
    /// Supernodes begin to end - 1.
    struct Subtree
    {
      int begin, end;
    };

    /// Consecutive rows of a supernode that are consecutive in its parent, at most as many as a slab has.
    struct Run
    {
      int place; ///< of the first one among the parent's rows
      int length;
    };

    /// Consecutive entries on A's pattern of which the places in a panel are this far apart.
    struct Entries
    {
      int begin; ///< on the pattern
      int place;
      int stride;
      int number;
    };

    int
    n() const
    {
      return static_cast<int>(permutation.size());
    }

    int
    n_supernodes() const
    {
      return static_cast<int>(parent.size());
    }

    int
    n_columns(const int s) const
    {
      return first_column[s + 1] - first_column[s];
    }

    int
    n_rows(const int s) const
    {
      return static_cast<int>(first_row[s + 1] - first_row[s]);
    }

    int
    n_below(const int s) const
    {
      return n_rows(s) - n_columns(s);
    }

    /// Places of a supernode's rows below its triangle among the rows of its parent, ascending.
    const int *
    rows_in_parent(const int s) const
    {
      return place_in_parent.data() + first_row[s] + n_columns(s);
    }

    /// Where a supernode's vector begins.
    std::size_t
    vector_begin(const int s) const
    {
      return first_row[s] + static_cast<std::size_t>(s) * slab_rows;
    }

    /// Size of the vectors of all supernodes.
    std::size_t
    n_of_vectors() const
    {
      return vector_begin(n_supernodes());
    }

    std::size_t
    n_values() const
    {
      return first_value.back();
    }

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

    std::vector<int>              permutation;  ///< row i of L is row permutation[i] of A
    std::vector<int>              first_column; ///< first column of each supernode, and n
    std::vector<std::size_t>      first_row; ///< begin of its rows among those of all, and the end
    std::vector<std::size_t>      first_value; ///< begin of its panel among the values, and the end
    std::vector<int>              parent;      ///< parent of each supernode; -1: none
    std::vector<std::vector<int>> children;    ///< ascending
    std::vector<int>
        place_in_parent; ///< by row below the triangle: its place among the parent's rows
    std::vector<std::size_t> first_run; ///< begin of a supernode's runs, and the end
    std::vector<Run>         runs;
    std::vector<std::size_t> first_entries; ///< begin of a supernode's entries of A, and the end
    std::vector<Entries>     entries;
    std::vector<Subtree>     subtrees;          ///< ascending
    std::vector<int>         top;               ///< the supernodes above them, ascending
    double                   n_operations = 0.; ///< operations of a factorisation
  };
} // namespace Exemplar

#endif
