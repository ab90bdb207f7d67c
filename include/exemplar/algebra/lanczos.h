// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_lanczos_h
#define exemplar_lanczos_h

#include <exemplar/algebra/block_matrix.h>

#include <functional>
#include <utility>

namespace Exemplar
{
  /// The preconditioner: from a residual to the preconditioned residual, owned blocks.
  using Precondition = std::function<const BlockVector &(const BlockVector &residual)>;

  /// Number of steps, enough for the eigenvalues by measurement, doc/measured.md.
  constexpr unsigned int n_lanczos_steps = 8;

  /// Estimates of the least and the greatest eigenvalue of a preconditioned matrix, both symmetric
  /// and positive definite, by n_lanczos_steps steps of Lanczos' method: the least is over-, the
  /// greatest underestimated. Without rows they are 0.5 and 1. Collective on `exchange`.
  std::pair<double, double>
  find_eigenvalues(const BlockMatrix  &matrix,
                   const Precondition &precondition,
                   const Exchange     &exchange);
} // namespace Exemplar

#endif
