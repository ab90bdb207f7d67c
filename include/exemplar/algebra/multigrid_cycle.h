// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_cycle_h
#define exemplar_multigrid_cycle_h

#include <exemplar/algebra/coarsest_inverse.h>
#include <exemplar/algebra/multigrid_hierarchy.h>

#include <vector>

namespace Exemplar
{
  /// How often a cycle comes to coarser levels: once, or twice from each finer level, which takes more
  /// time and leaves less of an error.
  enum class CycleShape
  {
    V,
    W
  };

  /// A cycle of multigrid in single precision, with Chebyshev's polynomials of a block-diagonal
  /// preconditioner as smoothers: a symmetric positive definite operation, about the inverse of the
  /// finest matrix.
  class MultigridCycle
  {
  public:
    /// All processes of `exchange`, which must outlive this, have a part of the hierarchy and must
    /// call this and apply().
    MultigridCycle(std::vector<MultigridLevel> hierarchy, const Exchange &exchange);

    /// About A^-1 residual, own blocks; here until the next call.
    const BlockVector &
    apply(const BlockVector &residual, CycleShape shape);

    const BlockMatrix &
    matrix() const
    {
      return levels[0].matrix;
    }

    /// Blocks of matrices that a V cycle multiplies by, of this process.
    double
    n_blocks() const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// The matrix of one level, the way to it from the next coarser one, and what a cycle computes
    /// on it.
    struct Level : MultigridLevel
    {
      explicit Level(MultigridLevel level);

      std::vector<float> inverse_diagonal; ///< 9 numbers a block, by columns
      double             maximum = 0.;     ///< eigenvalue of the matrix over its diagonal
      BlockVector        solution, right_side, correction, residual;
      BlockVector        coarser; ///< by columns of the prolongation
    };

    /// From right_side to solution of a level.
    void
    cycle(std::size_t number, CycleShape shape);

    /// As often as the shape asks for.
    void
    visit(std::size_t number, CycleShape shape);

    void
    smooth(Level &level, bool from_zero) const;

    std::vector<Level> levels; ///< the finest first
    CoarsestInverse    coarsest;
  };
} // namespace Exemplar

#endif
