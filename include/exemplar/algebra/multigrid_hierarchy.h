// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_hierarchy_h
#define exemplar_multigrid_hierarchy_h

#include <exemplar/algebra/block_matrix.h>
#include <exemplar/algebra/distributed_rows.h>

#include <functional>
#include <vector>

namespace Exemplar
{
  /// A level of a multigrid hierarchy: its matrix, and the prolongation from the next coarser
  /// level.
  struct MultigridLevel
  {
    BlockMatrix matrix, prolongation; ///< no prolongation on the coarsest level
  };

  /// A library's setup of algebraic multigrid for a matrix: its levels, the finest first, whose
  /// coarse spaces hold the near null space `modes`, see rigid_modes(). Collective on the processes
  /// that have rows, under a TrilinosLock. Throws SolverFailure on all processes.
  using MakeHierarchy = std::function<std::vector<MultigridLevel>(DistributedRows    &rows,
                                                                  std::vector<double> modes)>;

  /// Add a sum of outer products, with the block rows of the finest matrix, to all levels:
  /// unassembled to the finest, as assembled Galerkin products P^T (.) P to the coarser ones.
  /// Collective.
  void
  add_products(const OuterProducts         &products,
               std::vector<MultigridLevel> &levels,
               const Exchange              &exchange);
} // namespace Exemplar

#endif
