// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/cholmod_analysis.h>
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>

#include <fmt/core.h>

#include <mutex>

namespace Exemplar
{
  CholmodCommon::CholmodCommon()
  {
    cholmod_start(&common);
    common.print      = 0;                  // it would print about indefinite matrices; we throw
    common.supernodal = CHOLMOD_SUPERNODAL; // L D L^T, its choice for small matrices, lets
                                            // indefinite ones pass
  }

  CholmodCommon::~CholmodCommon()
  {
    cholmod_finish(&common);
  }

  void
  CholmodCommon::check(const std::string &what) const
  {
    if (common.status == CHOLMOD_NOT_POSDEF)
      throw indefinite_matrix();
    if (common.status == CHOLMOD_TOO_LARGE || common.status == CHOLMOD_OUT_OF_MEMORY)
      throw SolverFailure("CHOLMOD's " + what
                          + " needs more memory than there is. Set Solver/Linear solver to "
                            "iterative, or use a coarser mesh.");
    if (common.status < CHOLMOD_OK)
      throw SolverFailure(fmt::format("CHOLMOD's {} failed with status {}.", what, common.status));
  }

  cholmod_sparse
  cholmod_view(const SymmetricPattern &pattern, const double *values)
  {
    cholmod_sparse matrix{};
    matrix.nrow   = pattern.n();
    matrix.ncol   = pattern.n();
    matrix.nzmax  = pattern.row.size();
    matrix.p      = const_cast<int *>(pattern.column_start.data());
    matrix.i      = const_cast<int *>(pattern.row.data());
    matrix.x      = const_cast<double *>(values);
    matrix.stype  = -1; // the lower triangle
    matrix.itype  = CHOLMOD_INT;
    matrix.xtype  = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
    matrix.dtype  = CHOLMOD_DOUBLE;
    matrix.sorted = 1;
    matrix.packed = 1;
    return matrix;
  }

  cholmod_factor *
  analyze(const SymmetricPattern &pattern, CholmodCommon &common, const std::vector<int> &order)
  {
    // One thread at a time: METIS, which orders large matrices, draws from the C library's global
    // sequence of random numbers, and the ordering decides the last digits.
    static std::mutex                 of_random_numbers;
    const std::lock_guard<std::mutex> lock(of_random_numbers);
    const OneOpenMPThread             one_thread;
    cholmod_sparse                    matrix = cholmod_view(pattern, nullptr);
    cholmod_common *const             state  = &common;
    if (!order.empty())
    {
      state->nmethods           = 1;
      state->method[0].ordering = CHOLMOD_GIVEN;
    }
    int *const given = order.empty() ? nullptr : const_cast<int *>(order.data()); // it is only read
    cholmod_factor *factor = cholmod_analyze_p(&matrix, given, nullptr, 0, state);
    common.check("analysis");
    return factor;
  }

  namespace
  {
    /// The supernode of each column of L.
    std::vector<int>
    supernodes(const FactorStructure &structure)
    {
      std::vector<int> result(structure.n());
      for (int s = 0; s < structure.n_supernodes(); ++s)
        std::fill(result.begin() + structure.first_column[s],
                  result.begin() + structure.first_column[s + 1], s);
      return result;
    }

    void
    find_parents(FactorStructure &structure)
    {
      structure.parent.assign(structure.first_column.size() - 1, -1);
      const std::vector<int> supernode_of = supernodes(structure);
      for (int s = 0; s < structure.n_supernodes(); ++s)
        if (structure.n_rows(s) > structure.n_columns(s))
          structure.parent[s]
              = supernode_of[structure.rows[structure.first_row[s] + structure.n_columns(s)]];
    }

    /// Set place_of[row] to the position of each row of a supernode in its panel.
    void
    mark_rows(const FactorStructure &structure, const int s, std::vector<int> &place_of)
    {
      for (int i = 0; i < structure.n_rows(s); ++i)
        place_of[structure.rows[structure.first_row[s] + i]] = i;
    }

    void
    find_places_in_parents(FactorStructure &structure)
    {
      std::vector<std::vector<int>> children(structure.n_supernodes());
      for (int s = 0; s < structure.n_supernodes(); ++s)
        if (structure.parent[s] >= 0)
          children[structure.parent[s]].push_back(s);
      std::vector<int> place_of(structure.n());
      structure.place_in_parent.resize(structure.rows.size());
      for (int s = 0; s < structure.n_supernodes(); ++s)
      {
        mark_rows(structure, s, place_of);
        for (const int child : children[s])
          for (std::size_t i = structure.first_row[child] + structure.n_columns(child);
               i < structure.first_row[child + 1]; ++i)
            structure.place_in_parent[i] = place_of[structure.rows[i]];
      }
    }

    /// Sort the entries of A by supernode, by counting sort in two passes.
    void
    find_entries(const SymmetricPattern &pattern, FactorStructure &structure)
    {
      const int              n            = structure.n();
      const std::vector<int> supernode_of = supernodes(structure);
      std::vector<int>       row_of(n), row(pattern.row.size()), column(pattern.row.size());
      for (int i = 0; i < n; ++i)
        row_of[structure.permutation[i]] = i;
      structure.first_entry.assign(structure.n_supernodes() + 1, 0);
      for (int j = 0; j < n; ++j)
        for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
        {
          row[k]    = std::max(row_of[pattern.row[k]], row_of[j]);
          column[k] = std::min(row_of[pattern.row[k]], row_of[j]);
          ++structure.first_entry[supernode_of[column[k]] + 1];
        }
      for (int s = 0; s < structure.n_supernodes(); ++s)
        structure.first_entry[s + 1] += structure.first_entry[s];
      std::vector<std::size_t> next(structure.first_entry.begin(), structure.first_entry.end() - 1);
      structure.entry.resize(pattern.row.size());
      for (std::size_t k = 0; k < row.size(); ++k)
        structure.entry[next[supernode_of[column[k]]]++] = static_cast<int>(k);
      std::vector<int> place_of(n);
      structure.place.resize(pattern.row.size());
      for (int s = 0; s < structure.n_supernodes(); ++s)
      {
        mark_rows(structure, s, place_of);
        for (std::size_t e = structure.first_entry[s]; e < structure.first_entry[s + 1]; ++e)
          structure.place[e]
              = (column[structure.entry[e]] - structure.first_column[s]) * structure.n_rows(s)
                + place_of[row[structure.entry[e]]];
      }
    }

    /// Floating point operations of the subtree below each supernode, itself included.
    std::vector<double>
    operations_of_subtrees(const FactorStructure &structure)
    {
      std::vector<double> operations(structure.n_supernodes(), 0.);
      for (int s = 0; s < structure.n_supernodes(); ++s)
      {
        for (int c = 0; c < structure.n_columns(s); ++c)
          operations[s] += std::pow(structure.n_rows(s) - c, 2);
        if (structure.parent[s] >= 0)
          operations[structure.parent[s]] += operations[s];
      }
      return operations;
    }

    /// Renumber a subtree's ancestor rows into its private tail: the rows of its root below the
    /// triangle, which include those of all its supernodes.
    void
    give_tail(FactorStructure &structure, FactorStructure::Subtree &subtree)
    {
      const int root        = subtree.end - 1;
      const int first_above = structure.first_column[subtree.end];
      subtree.begin_of_tail = static_cast<int>(structure.tail.size());
      const auto above      = structure.rows.begin()
                         + static_cast<std::ptrdiff_t>(structure.first_row[root])
                         + structure.n_columns(root);
      structure.tail.insert(structure.tail.end(), above,
                            structure.rows.begin()
                                + static_cast<std::ptrdiff_t>(structure.first_row[root + 1]));
      subtree.end_of_tail = static_cast<int>(structure.tail.size());
      const auto begin = structure.tail.begin() + subtree.begin_of_tail, end = structure.tail.end();
      for (std::size_t i = structure.first_row[subtree.begin]; i < structure.first_row[subtree.end];
           ++i)
        if (structure.rows[i] >= first_above)
          structure.rows[i] = structure.n()
                              + static_cast<int>(std::lower_bound(begin, end, structure.rows[i])
                                                 - structure.tail.begin());
    }

    /// Cut the elimination tree where a subtree takes at most a thirtieth of the operations, or no
    /// longer than starting a thread.
    void
    find_subtrees(FactorStructure &structure)
    {
      const std::vector<double> operations = operations_of_subtrees(structure);
      const auto                is_of_top  = [&](const int s)
      { return operations[s] > std::max(structure.n_operations / 30., 2e5); };
      int begin = 0;
      for (int s = 0; s < structure.n_supernodes(); ++s)
      {
        const int parent = structure.parent[s];
        if (is_of_top(s))
          structure.top.push_back(s);
        else if (parent < 0 || is_of_top(parent))
          structure.subtrees.push_back({ begin, s + 1, 0, 0 });
        else
          continue;
        begin = s + 1;
      }
      for (FactorStructure::Subtree &subtree : structure.subtrees)
        give_tail(structure, subtree);
    }
  } // namespace

  FactorStructure
  factor_structure(const SymmetricPattern &pattern,
                   const cholmod_factor   &factor,
                   const CholmodCommon    &common)
  {
    const auto *super   = static_cast<const int *>(factor.super);
    const auto *row     = static_cast<const int *>(factor.pi);
    const auto *value   = static_cast<const int *>(factor.px);
    const auto *rows    = static_cast<const int *>(factor.s);
    const auto *order   = static_cast<const int *>(factor.Perm);
    const auto  n_super = static_cast<std::ptrdiff_t>(factor.nsuper);

    FactorStructure structure;
    structure.permutation.assign(order, order + factor.n);
    structure.first_column.assign(super, super + n_super + 1);
    structure.first_row.assign(row, row + n_super + 1);
    structure.first_value.assign(value, value + n_super + 1);
    structure.rows.assign(rows, rows + row[n_super]);
    structure.n_operations = common->fl;
    for (int s = 0; s < static_cast<int>(n_super); ++s)
      structure.max_rows = std::max(structure.max_rows, structure.n_rows(s));
    find_parents(structure);
    find_places_in_parents(structure);
    find_entries(pattern, structure);
    find_subtrees(structure);
    return structure;
  }

  std::size_t
  FactorStructure::memory_consumption() const
  {
    return sizeof(int)
               * (permutation.size() + first_column.size() + rows.size() + parent.size()
                  + place_in_parent.size() + entry.size() + place.size() + top.size() + tail.size())
           + sizeof(std::size_t) * (first_row.size() + first_value.size() + first_entry.size())
           + sizeof(Subtree) * subtrees.size();
  }
} // namespace Exemplar
