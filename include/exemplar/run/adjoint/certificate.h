// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_certificate_h
#define exemplar_certificate_h

#include <exemplar/run/adjoint/slope_derivatives.h>

namespace Exemplar
{
  /// What a function J(x, w) of the equilibrium beside the problem's state is more than J at the state, to
  /// first order: -(a.dPhi/dx + b.dPhi/dw) with the adjoint direction (a, b) of its derivatives, which is
  /// what a Newton step with the exact tangent would change of J. The state need be no equilibrium; held
  /// nodes and weights at their bounds stay. Throws UserError for scenes whose gradients are not known and
  /// where the rotation of a cell is not unique, and SolverFailure if the exact tangent is not positive definite. The problem stays
  /// as it is.
  double
  correction(Problem &problem, const Direction &by_state);
} // namespace Exemplar

#endif
