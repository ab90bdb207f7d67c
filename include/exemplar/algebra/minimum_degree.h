// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_minimum_degree_h
#define exemplar_minimum_degree_h

#include <exemplar/algebra/spd_operator.h>

namespace Exemplar
{
  /// Floating point operations of a Cholesky factorisation of a pattern in an order by minimum degree, which is found much
  /// faster than the best one: an upper bound of that order's, within a factor of about twenty where bodies are large.
  /// Throws SolverFailure.
  double
  operations_by_minimum_degree(const SymmetricPattern &pattern);
} // namespace Exemplar

#endif
