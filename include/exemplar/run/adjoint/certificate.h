// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_certificate_h
#define exemplar_certificate_h

#include <exemplar/run/adjoint/slope_derivatives.h>

namespace Exemplar
{
  /// First-order change of J(x, w) from the problem's state to the equilibrium nearby: -(a.dPhi/dx
  /// + b.dPhi/dw) with the adjoint direction (a, b) of J's derivatives, the same as by a Newton
  /// step with the exact tangent. The state need be no equilibrium; held nodes and weights at their
  /// bounds stay. Throws UserError for scenes whose gradients are not known and where the rotation
  /// of a cell is not unique, and SolverFailure if the exact tangent is not positive definite. The
  /// problem stays as it is.
  double
  correction(Problem &problem, const Direction &by_state);
} // namespace Exemplar

#endif
