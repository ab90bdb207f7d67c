// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_lanczos_h
#define exemplar_lanczos_h

#include <exemplar/algebra/block_matrix.h>

#include <functional>
#include <utility>

namespace Exemplar
{
  /// From the residual to what the preconditioner makes of it, own blocks.
  using Precondition = std::function<const BlockVector &(const BlockVector &residual)>;

  /// The least and the greatest eigenvalue of a preconditioned matrix, both symmetric and positive
  /// definite, as a few steps of Lanczos' method find them: too great and too small. Without rows
  /// they are 0.5 and 1. All processes of `exchange` must call this.
  std::pair<double, double>
  find_eigenvalues(const BlockMatrix  &matrix,
                   const Precondition &precondition,
                   unsigned int        n_steps,
                   const Exchange     &exchange);
} // namespace Exemplar

#endif
