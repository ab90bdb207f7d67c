// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_hierarchy_h
#define exemplar_multigrid_hierarchy_h

#include <exemplar/algebra/block_matrix.h>
#include <exemplar/algebra/vector.h>

#include <vector>

namespace Exemplar
{
  /// A matrix of a multigrid hierarchy, and how its vectors come from those of the next level.
  struct MultigridLevel
  {
    BlockMatrix matrix, prolongation; ///< no prolongation on the coarsest level
  };

  /// What a library makes of DistributedRows: algebraic multigrid. All processes that have rows
  /// must call its functions.
  class MultigridHierarchy
  {
  public:
    virtual ~MultigridHierarchy() = default;

    /// A hierarchy of the rows with the values that they have now, of which the coarse spaces hold
    /// what rigid_modes() gives. Throws SolverFailure in all processes.
    virtual void
    make(std::vector<double> modes)
        = 0;

    /// Free what make() has made.
    virtual void
    clear()
        = 0;

    /// image = about A^-1 vector, by own rows: a symmetric positive definite operation.
    virtual void
    apply(const Vector &vector, Vector &image) const = 0;

    /// The levels, the finest first.
    virtual std::vector<MultigridLevel>
    copy() const = 0;
  };
} // namespace Exemplar

#endif
