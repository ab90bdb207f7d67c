// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_balance_h
#define exemplar_balance_h

#include <exemplar/potential/initial_stress_term.h>
#include <exemplar/run/problem/problem_parts.h>

namespace Exemplar
{
  /// The stresses that hold a body in its rest pose under the loads of t = 0 (Loads/Balanced): tau
  /// = C : sym grad u with K u = f at rest, corrected until sum V tau g = f to rounding on the free
  /// degrees of freedom. If the linear solver factorises, `warnings` tells of a rest pose that is
  /// not stable. Throws UserError for loads that cannot be balanced. All processes must call this.
  PointStresses
  initial_stresses(const SceneParameters    &parameters,
                   const Body               &body,
                   Examples                 &examples,
                   const Constraints        &constraints,
                   const Loads              *loads,
                   std::vector<std::string> &warnings);
} // namespace Exemplar

#endif
