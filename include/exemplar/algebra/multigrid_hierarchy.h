// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_hierarchy_h
#define exemplar_multigrid_hierarchy_h

#include <exemplar/algebra/block_matrix.h>
#include <exemplar/algebra/distributed_rows.h>

#include <functional>
#include <vector>

namespace Exemplar
{
  /// A matrix of a multigrid hierarchy, and how its vectors come from those of the next level.
  struct MultigridLevel
  {
    BlockMatrix matrix, prolongation; ///< no prolongation on the coarsest level
  };

  /// What a library makes of rows with the values that they have now: the levels of algebraic
  /// multigrid, the finest first, of which the coarse spaces hold what rigid_modes() gives. All
  /// processes that have rows must call it, under a TrilinosLock. Throws SolverFailure in all
  /// processes.
  using MakeHierarchy = std::function<std::vector<MultigridLevel>(DistributedRows    &rows,
                                                                  std::vector<double> modes)>;

  /// Add a sum of outer products, with the blocks of the finest matrix, to all levels: as it is to
  /// the finest, and the Galerkin products P^T (.) P, assembled, to the coarser ones. All processes
  /// must call this.
  void
  add_products(const OuterProducts         &products,
               std::vector<MultigridLevel> &levels,
               const Exchange              &exchange);
} // namespace Exemplar

#endif
