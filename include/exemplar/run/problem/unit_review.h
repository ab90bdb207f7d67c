// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_unit_review_h
#define exemplar_unit_review_h

#include <exemplar/run/problem/body_measures.h>
#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Estimated effect of gravity on a held body, without solving anything.
  struct WeightEstimate
  {
    double sag;    ///< displacement of its furthest part [m]
    double strain; ///< rho g / E times the distance of that part from the held nodes
  };

  /// Estimate for statics, and in dynamics at most the free fall within the run. With the distance
  /// d of a node from the nearest handle's bounding box, its part d' across gravity, and the
  /// thickness t: rho g / E (d^2 / 2 + 3/2 d'^4 / t^2), for a stretched bar and a bent beam. Exact
  /// for both; doc/output.md tells its accuracy. Zero if nothing is held. All processes must call
  /// this.
  WeightEstimate
  estimate_weight(const Problem &problem, const BodyMeasures &measures);

  /// Warnings of numbers that suggest a wrong unit: the size of the body, its density and
  /// stiffness, the effects of gravity and forces, times, and degrees in formulas. All processes
  /// that share the body must call this.
  std::vector<std::string>
  unit_warnings(const Problem &problem);
} // namespace Exemplar

#endif
