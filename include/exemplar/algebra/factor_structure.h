// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_factor_structure_h
#define exemplar_factor_structure_h

#include <cstddef>
#include <vector>

// Symbolic structure of a sparse Cholesky factor. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// The factor L of P A P^T = L L^T by supernodes, consecutive columns with the same rows below
  /// their triangle. The columns of a supernode are a dense panel, stored by columns; its first
  /// rows are the supernode's own columns. The parent of a supernode in the elimination tree is the
  /// supernode of its first row below the triangle; children come before parents.
  ///
  /// Disjoint subtrees of the elimination tree share no rows but those of the supernodes above
  /// them, the top. So that each can be solved independently, vectors have a tail: entry n + i is
  /// one subtree's private copy of row tail[i].
  struct FactorStructure
  {
    /// Supernodes begin to end - 1, and their range in the tail.
    struct Subtree
    {
      int begin, end;
      int begin_of_tail, end_of_tail;
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

    std::size_t
    n_values() const
    {
      return first_value.back();
    }

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

    std::vector<int>         permutation;  ///< row i of L is row permutation[i] of A
    std::vector<int>         first_column; ///< first column of each supernode, and n
    std::vector<std::size_t> first_row;    ///< begin of its rows in `rows`, and the end
    std::vector<std::size_t> first_value;  ///< begin of its panel among the values, and the end
    std::vector<int>         rows;         ///< ascending; top rows are in the tail for subtrees
    std::vector<int>         parent;       ///< parent of each supernode; -1: none
    std::vector<int> place_in_parent;      ///< position of each of `rows` below the triangle among
                                           ///< the parent's rows
    std::vector<std::size_t> first_entry;  ///< begin of a supernode's entries of A, and the end
    std::vector<int>         entry;        ///< position of the entry on A's pattern
    std::vector<int>         place;        ///< its position in the panel
    std::vector<Subtree>     subtrees;     ///< ascending
    std::vector<int>         top;          ///< the supernodes above them, ascending
    std::vector<int>         tail;
    int                      max_rows     = 0;  ///< greatest number of rows of a supernode
    double                   n_operations = 0.; ///< operations of a factorisation
  };
} // namespace Exemplar

#endif
