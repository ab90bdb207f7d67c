// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_scatter_h
#define exemplar_cell_scatter_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/potential/cell_field.h>

#include <utility>
#include <vector>

namespace Exemplar
{
  /// The pattern of matrices on the free degrees of freedom that couple nodes which share a cell,
  /// and further pairs of nodes.
  SymmetricPattern
  make_pattern(const FESpace                                            &fe_space,
               const std::vector<std::pair<unsigned int, unsigned int>> &couplings,
               const FreeDofs                                           &free_dofs);

  /// Where the entries of the cells' matrices are in the matrix of the body. Made for the pattern and
  /// the free degrees of freedom as they are.
  class CellScatter
  {
  public:
    /// All must outlive it.
    CellScatter(const FESpace          &fe_space,
                const SymmetricPattern &pattern,
                const FreeDofs         &free_dofs);

    /// TangentTask::positions from the first batch of points on; -1 for cells with both free and held
    /// components at a node (mixed cells).
    const int *
    positions() const
    {
      return block_positions.data();
    }

    /// Cells with a node of which only some components are held: their blocks are not added as
    /// whole columns.
    const std::vector<unsigned int> &
    mixed_cells() const
    {
      return mixed;
    }

    /// Cells with a node that is held in some component.
    const std::vector<unsigned int> &
    cells_beside_held_nodes() const
    {
      return beside_held;
    }

    /// Add the blocks of a cell, each by columns of three, to the values on the pattern.
    void
    add_blocks(unsigned int cell, const double *blocks, std::vector<double> &values) const;

    /// Nodes of a cell in the order of the loops, which is ascending.
    std::vector<unsigned int>
    nodes(unsigned int cell) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// The same for a cell that is not mixed, without a search.
    void
    add_at_positions(unsigned int cell, const double *blocks, std::vector<double> &values) const;

    void
    find_positions(unsigned int cell, const std::vector<int> &n_held);

    const FESpace            &fe_space;
    const SymmetricPattern   &pattern;
    const FreeDofs           &free_dofs;
    std::vector<int>          block_positions;
    std::vector<unsigned int> mixed;
    std::vector<unsigned int> beside_held;
  };
} // namespace Exemplar

#endif
