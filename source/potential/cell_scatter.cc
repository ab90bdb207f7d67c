// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/cell_scatter.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <map>

namespace Exemplar
{
  namespace
  {
    using Neighbours = std::map<unsigned int, std::vector<unsigned int>>;

    /// The couplings of each node.
    Neighbours
    neighbours_of(const std::vector<std::pair<unsigned int, unsigned int>> &couplings)
    {
      Neighbours neighbours;
      for (const auto &[a, b] : couplings)
      {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
      }
      return neighbours;
    }

    int
    n_held_components(const FreeDofs &free_dofs, const unsigned int node)
    {
      int n = 0;
      for (unsigned int c = 0; c < 3; ++c)
        n += (free_dofs.free_index(3 * node + c) == FreeDofs::held);
      return n;
    }
  } // namespace

  SymmetricPattern
  make_pattern(const FESpace                                            &fe_space,
               const std::vector<std::pair<unsigned int, unsigned int>> &couplings,
               const FreeDofs                                           &free_dofs)
  {
    const dealii::SparsityPattern nodal = fe_space.nodal_pattern();
    const Neighbours              extra = neighbours_of(couplings);
    SymmetricPattern              pattern;
    pattern.column_start.push_back(0);
    for (const unsigned int dof : free_dofs.local_list())
    {
      const auto begin    = pattern.row.size();
      const auto add_node = [&](const unsigned int node)
      {
        for (unsigned int c = 0; c < 3; ++c)
          if (const unsigned int other = 3 * node + c; other >= dof)
            if (const int row = free_dofs.free_index(other); row != FreeDofs::held)
              pattern.row.push_back(row);
      };
      for (auto entry = nodal.begin(dof / 3); entry != nodal.end(dof / 3); ++entry)
        add_node(entry->column());
      if (const auto more = extra.find(dof / 3); more != extra.end())
        std::for_each(more->second.begin(), more->second.end(), add_node);
      std::sort(pattern.row.begin() + begin, pattern.row.end());
      pattern.row.erase(std::unique(pattern.row.begin() + begin, pattern.row.end()),
                        pattern.row.end());
      pattern.column_start.push_back(pattern.row.size());
    }
    return pattern;
  }

  CellScatter::CellScatter(const FESpace          &fe_space,
                           const SymmetricPattern &pattern,
                           const FreeDofs         &free_dofs)
      : fe_space(fe_space), pattern(pattern), free_dofs(free_dofs)
  {
    block_positions.assign(n_block_columns(nodes_per_cell(fe_space.element())) * fe_space.n_cells(),
                           FreeDofs::held);
    mixed.clear();
    beside_held.clear();
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      std::vector<int> n_held;
      for (const unsigned int node : nodes(cell))
        n_held.push_back(n_held_components(free_dofs, node));
      if (std::any_of(n_held.begin(), n_held.end(), [](const int n) { return n > 0; }))
        beside_held.push_back(cell);
      if (std::any_of(n_held.begin(), n_held.end(), [](const int n) { return n == 1 || n == 2; }))
        mixed.push_back(cell);
      else
        find_positions(cell, n_held);
    }
  }

  std::vector<unsigned int>
  CellScatter::nodes(const unsigned int cell) const
  {
    const auto                of_cell = fe_space.nodes(cell);
    std::vector<unsigned int> ascending(of_cell.begin(), of_cell.end());
    std::sort(ascending.begin(), ascending.end());
    return ascending;
  }

  void
  CellScatter::find_positions(const unsigned int cell, const std::vector<int> &n_held)
  {
    const std::vector<unsigned int> node = nodes(cell);
    int *position                        = &block_positions[n_block_columns(node.size()) * cell];
    for (unsigned int a = 0; a < node.size(); ++a)
      for (unsigned int b = 0; b <= a; ++b)
        for (unsigned int j = 0; j < 3; ++j, ++position)
          if (n_held[a] == 0 && n_held[b] == 0)
          {
            const int column = free_dofs.free_index(3 * node[b] + j);
            *position        = a == b ? pattern.position(column, column) - static_cast<int>(j)
                                      : pattern.position(free_dofs.free_index(3 * node[a]), column);
          }
  }

  void
  CellScatter::add_blocks(const unsigned int   cell,
                          const double        *blocks,
                          std::vector<double> &values) const
  {
    if (!std::binary_search(mixed.begin(), mixed.end(), cell))
    {
      add_at_positions(cell, blocks, values);
      return;
    }
    const std::vector<unsigned int> node = nodes(cell);
    for (unsigned int a = 0; a < node.size(); ++a)
      for (unsigned int b = 0; b <= a; ++b)
        for (unsigned int j = 0; j < 3; ++j)
          for (unsigned int i = 0; i < 3; ++i, ++blocks)
          {
            const int row    = free_dofs.free_index(3 * node[a] + i);
            const int column = free_dofs.free_index(3 * node[b] + j);
            if (row != FreeDofs::held && column != FreeDofs::held && row >= column)
              values[pattern.position(row, column)] += *blocks;
          }
  }

  void
  CellScatter::add_at_positions(const unsigned int   cell,
                                const double        *blocks,
                                std::vector<double> &values) const
  {
    const auto n_nodes  = static_cast<unsigned int>(nodes_per_cell(fe_space.element()));
    const int *position = &block_positions[n_block_columns(n_nodes) * cell];
    for (unsigned int a = 0; a < n_nodes; ++a)
      for (unsigned int b = 0; b <= a; ++b)
        for (unsigned int j = 0; j < 3; ++j, ++position, blocks += 3)
          if (*position != FreeDofs::held)
            for (unsigned int i = a == b ? j : 0; i < 3; ++i)
              values[*position + i] += blocks[i];
  }

  std::size_t
  CellScatter::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return memory_consumption(block_positions) + memory_consumption(mixed)
           + memory_consumption(beside_held);
  }
} // namespace Exemplar
