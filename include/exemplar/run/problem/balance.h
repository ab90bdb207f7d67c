// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_balance_h
#define exemplar_balance_h

#include <exemplar/potential/initial_stress_term.h>
#include <exemplar/run/problem/problem_parts.h>

namespace Exemplar
{
  /// The stresses with which a body stands in its rest pose under the loads of t = 0 (Loads/Balanced):
  /// tau = C : sym grad u with K u = f at rest, corrected until sum V tau g = f to rounding on what is free.
  /// Where the linear solver makes a factor, `warnings` gets a word on a body that would not stay there. Throws
  /// UserError for what cannot be balanced. All processes must call this.
  PointStresses
  initial_stresses(const SceneParameters    &parameters,
                   const Body               &body,
                   Examples                 &examples,
                   const Constraints        &constraints,
                   const Loads              *loads,
                   std::vector<std::string> &warnings);
} // namespace Exemplar

#endif
