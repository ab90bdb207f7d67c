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

  /// As many find the eigenvalues well enough, by measurement, doc/measured.md.
  constexpr unsigned int n_lanczos_steps = 8;

  /// The least and the greatest eigenvalue of a preconditioned matrix, both symmetric and positive
  /// definite, as these steps of Lanczos' method find them: too great and too small. Without rows
  /// they are 0.5 and 1. All processes of `exchange` must call this.
  std::pair<double, double>
  find_eigenvalues(const BlockMatrix  &matrix,
                   const Precondition &precondition,
                   const Exchange     &exchange);
} // namespace Exemplar

#endif
