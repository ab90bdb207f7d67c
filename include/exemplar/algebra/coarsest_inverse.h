// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_coarsest_inverse_h
#define exemplar_coarsest_inverse_h

#include <exemplar/algebra/block_matrix.h>

#include <vector>

namespace Exemplar
{
  /// The dense inverse of the coarsest multigrid matrix in single precision, distributed by rows.
  /// Rows and columns that Cholesky's factorisation finds linearly dependent are zero.
  class CoarsestInverse
  {
  public:
    /// `exchange` must outlive this. All processes must call this and solve().
    CoarsestInverse(const BlockMatrix &matrix, const Exchange &exchange);

    void
    solve(const BlockVector &right_side, BlockVector &solution) const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const
    {
      return sizeof(float) * inverse.capacity();
    }

  private:
    const Exchange          &exchange;
    std::vector<std::size_t> firsts; ///< first_numbers() of the rows
    std::vector<float>       inverse;
  };
} // namespace Exemplar

#endif
