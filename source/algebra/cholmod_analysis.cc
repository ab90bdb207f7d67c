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
  CholmodCommon::join_more_supernodes()
  {
    // up to so many columns are joined if at most this share of their entries are zeros
    common.nrelax[0] = 16; // always
    common.nrelax[1] = 32;
    common.zrelax[0] = 0.8;
    common.nrelax[2] = 96;
    common.zrelax[1] = 0.15;
    common.zrelax[2] = 0.05; // any
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
    if (!order.empty() || pattern.is_of_surface)
    {
      state->nmethods           = 1;
      state->method[0].ordering = order.empty() ? CHOLMOD_NESDIS : CHOLMOD_GIVEN;
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
    find_parents(FactorStructure &structure, const int *rows)
    {
      structure.parent.assign(structure.first_column.size() - 1, -1);
      const std::vector<int> supernode_of = supernodes(structure);
      for (int s = 0; s < structure.n_supernodes(); ++s)
        if (structure.n_rows(s) > structure.n_columns(s))
          structure.parent[s] = supernode_of[rows[structure.first_row[s] + structure.n_columns(s)]];
      structure.children.resize(structure.n_supernodes());
      for (int s = 0; s < structure.n_supernodes(); ++s)
        if (structure.parent[s] >= 0)
          structure.children[structure.parent[s]].push_back(s);
    }

    /// Set place_of[row] to the position of each row of a supernode in its panel.
    void
    mark_rows(const FactorStructure &structure,
              const int             *rows,
              const int              s,
              std::vector<int>      &place_of)
    {
      for (int i = 0; i < structure.n_rows(s); ++i)
        place_of[rows[structure.first_row[s] + i]] = i;
    }

    void
    find_places_in_parents(FactorStructure &structure, const int *rows)
    {
      std::vector<int> place_of(structure.n());
      structure.place_in_parent.resize(structure.first_row.back());
      for (int s = 0; s < structure.n_supernodes(); ++s)
      {
        mark_rows(structure, rows, s, place_of);
        for (const int child : structure.children[s])
          for (std::size_t i = structure.first_row[child] + structure.n_columns(child);
               i < structure.first_row[child + 1]; ++i)
            structure.place_in_parent[i] = place_of[rows[i]];
      }
    }

    void
    find_runs(FactorStructure &structure)
    {
      for (int s = 0; s < structure.n_supernodes(); ++s)
      {
        structure.first_run.push_back(structure.runs.size());
        const std::size_t end = structure.first_row[s + 1];
        for (std::size_t i = structure.first_row[s] + structure.n_columns(s); i < end;)
        {
          const std::size_t begin = i;
          const int         place = structure.place_in_parent[i];
          for (++i; i < end && i < begin + slab_rows
                    && structure.place_in_parent[i] == place + static_cast<int>(i - begin);)
            ++i;
          structure.runs.push_back({ place, static_cast<int>(i - begin) });
        }
      }
      structure.first_run.push_back(structure.runs.size());
    }

    void
    find_panels(FactorStructure &structure)
    {
      structure.first_value = { 0 };
      for (int s = 0; s < structure.n_supernodes(); ++s)
      {
        const int  n     = structure.n_columns(s);
        PanelBlock block = PanelBlock::first(n, structure.n_rows(s));
        while (block.column + block.width < n)
          block = block.next();
        structure.first_value.push_back(structure.first_value.back() + block.end());
      }
    }

    /// Place of an entry of the lower triangle in its panel.
    int
    place_in_panel(const int n_columns, const int n_rows, const int row, const int column)
    {
      PanelBlock block = PanelBlock::first(n_columns, n_rows);
      while (column >= block.column + block.width)
        block = block.next();
      const int k = column - block.column, i = row - block.column, below = i - block.width;
      const int first = (below < 0 ? i : below) / slab_rows * slab_rows;
      const int height
          = below < 0 ? block.slab_height(first) : std::min(slab_rows, block.n_below - first);
      const auto slab = below < 0 ? block.begin + PanelBlock::lower_slab(first)
                                  : block.below() + static_cast<std::size_t>(first) * block.width;
      return static_cast<int>(slab) + k * height + (below < 0 ? i : below) - first;
    }

    /// An entry of A becomes the next one of the last ones of this supernode, or the first of further ones.
    void
    add_entry(FactorStructure &structure, const int s, const int entry, const int place)
    {
      if (structure.entries.size() > structure.first_entries[s])
        if (FactorStructure::Entries &last = structure.entries.back();
            entry == last.begin + last.number
            && (last.number == 1 || place == last.place + last.number * last.stride))
        {
          last.stride = (place - last.place) / last.number;
          ++last.number;
          return;
        }
      structure.entries.push_back({ entry, place, 0, 1 });
    }

    /// Sort the entries of A by supernode, by counting sort in two passes.
    void
    find_entries(const SymmetricPattern &pattern, const int *rows, FactorStructure &structure)
    {
      const int              n            = structure.n();
      const std::vector<int> supernode_of = supernodes(structure);
      std::vector<int>       row_of(n), row(pattern.row.size()), column(pattern.row.size());
      for (int i = 0; i < n; ++i)
        row_of[structure.permutation[i]] = i;
      std::vector<std::size_t> first(structure.n_supernodes() + 1, 0);
      for (int j = 0; j < n; ++j)
        for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
        {
          row[k]    = std::max(row_of[pattern.row[k]], row_of[j]);
          column[k] = std::min(row_of[pattern.row[k]], row_of[j]);
          ++first[supernode_of[column[k]] + 1];
        }
      for (int s = 0; s < structure.n_supernodes(); ++s)
        first[s + 1] += first[s];
      std::vector<std::size_t> next(first.begin(), first.end() - 1);
      std::vector<int>         entry(pattern.row.size()), place_of(n);
      for (std::size_t k = 0; k < row.size(); ++k)
        entry[next[supernode_of[column[k]]]++] = static_cast<int>(k);
      for (int s = 0; s < structure.n_supernodes(); ++s)
      {
        structure.first_entries.push_back(structure.entries.size());
        mark_rows(structure, rows, s, place_of);
        const int n_columns = structure.n_columns(s), n_rows = structure.n_rows(s);
        for (std::size_t e = first[s]; e < first[s + 1]; ++e)
          add_entry(structure, s, entry[e],
                    place_in_panel(n_columns, n_rows, place_of[row[entry[e]]],
                                   column[entry[e]] - structure.first_column[s]));
      }
      structure.first_entries.push_back(structure.entries.size());
      structure.entries.shrink_to_fit();
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
          structure.subtrees.push_back({ begin, s + 1 });
        else
          continue;
        begin = s + 1;
      }
    }
  } // namespace

  FactorStructure
  factor_structure(const SymmetricPattern &pattern,
                   const cholmod_factor   &factor,
                   const CholmodCommon    &common)
  {
    const auto *super   = static_cast<const int *>(factor.super);
    const auto *row     = static_cast<const int *>(factor.pi);
    const auto *rows    = static_cast<const int *>(factor.s);
    const auto *order   = static_cast<const int *>(factor.Perm);
    const auto  n_super = static_cast<std::ptrdiff_t>(factor.nsuper);

    FactorStructure structure;
    structure.permutation.assign(order, order + factor.n);
    structure.first_column.assign(super, super + n_super + 1);
    structure.first_row.assign(row, row + n_super + 1);
    structure.n_operations = common->fl;
    find_parents(structure, rows);
    find_panels(structure);
    find_places_in_parents(structure, rows);
    find_runs(structure);
    find_entries(pattern, rows, structure);
    find_subtrees(structure);
    return structure;
  }

  std::size_t
  FactorStructure::memory_consumption() const
  {
    return sizeof(int)
               * (permutation.size() + first_column.size() + parent.size() + place_in_parent.size()
                  + top.size())
           + sizeof(std::size_t)
                 * (first_row.size() + first_value.size() + first_entries.size() + first_run.size())
           + (sizeof(std::vector<int>) + sizeof(int)) * children.size()
           + sizeof(Subtree) * subtrees.size() + sizeof(Run) * runs.size()
           + sizeof(Entries) * entries.size();
  }
} // namespace Exemplar
