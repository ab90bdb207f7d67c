// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_cycle_h
#define exemplar_multigrid_cycle_h

#include <exemplar/algebra/coarsest_inverse.h>
#include <exemplar/algebra/multigrid_hierarchy.h>

#include <vector>

namespace Exemplar
{
  /// Visits of each coarser level: one from each finer level, or two, which takes more time and
  /// reduces the error more.
  enum class CycleShape
  {
    V,
    W
  };

  /// A multigrid cycle in single precision with Chebyshev smoothers on a block-diagonal
  /// preconditioner: a symmetric positive definite approximation of the inverse of the finest
  /// matrix.
  class MultigridCycle
  {
  public:
    /// `exchange` must outlive this. This and apply() are collective; each process has a part of
    /// the hierarchy.
    MultigridCycle(std::vector<MultigridLevel> hierarchy, const Exchange &exchange);

    /// An approximation of A^-1 residual, owned blocks; valid until the next call.
    const BlockVector &
    apply(const BlockVector &residual, CycleShape shape);

    const BlockMatrix &
    matrix() const
    {
      return levels[0].matrix;
    }

    /// Number of matrix blocks of this process that a V cycle multiplies by.
    double
    n_blocks() const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// One level: its matrix, the prolongation from the next coarser level, and work vectors.
    struct Level : MultigridLevel
    {
      explicit Level(MultigridLevel level);

      std::vector<float> inverse_diagonal; ///< 9 numbers a block, by columns
      double             maximum = 0.;     ///< greatest eigenvalue of D^-1 A
      BlockVector        solution, right_side, correction, residual;
      BlockVector        coarser; ///< vector by columns of the prolongation
    };

    /// Compute a level's solution from its right_side.
    void
    cycle(std::size_t number, CycleShape shape);

    /// Run cycle() once or twice, as the shape demands.
    void
    visit(std::size_t number, CycleShape shape);

    void
    smooth(Level &level, bool from_zero) const;

    std::vector<Level> levels; ///< the finest first
    CoarsestInverse    coarsest;
  };
} // namespace Exemplar

#endif
