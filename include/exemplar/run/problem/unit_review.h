// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_unit_review_h
#define exemplar_unit_review_h

#include <exemplar/run/problem/body_measures.h>
#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// What gravity does to a body that is held, estimated without solving anything.
  struct WeightEstimate
  {
    double sag;    ///< how far its furthest part moves [m]
    double strain; ///< rho g / E times the distance of that part from what is held
  };

  /// In statics, and in dynamics no further than it can fall in the time of the run. From the distance d
  /// of a node from the nearest handle's bounding box, d' of it across gravity, and the thickness t:
  /// rho g / E (d^2 / 2 + 3/2 d'^4 / t^2), as a bar is stretched and a beam bends. Exact for both;
  /// doc/output.md says how near it comes. Zero where nothing is held. All processes must call this.
  WeightEstimate
  estimate_weight(const Problem &problem, const BodyMeasures &measures);

  /// Warnings of what looks like a wrong unit: the size of the body, its density and stiffness, what
  /// gravity and forces do to it, its times, and degrees in formulas. All processes that share the
  /// body must call this.
  std::vector<std::string>
  unit_warnings(const Problem &problem);
} // namespace Exemplar

#endif
