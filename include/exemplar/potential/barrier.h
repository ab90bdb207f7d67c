// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_barrier_h
#define exemplar_barrier_h

#include <cmath>
#include <limits>

namespace Exemplar
{
  /// Energy of a gap d [m]: b = -k w (s - 1)^2 ln s with s = d / w, zero for s >= 1, doc/contact.md. It is convex and
  /// has no end as d goes to 0; where d <= 0 it is infinite, never NaN, and has no derivatives.
  struct Barrier
  {
    double stiffness; ///< k [N]
    double width;     ///< w [m]: from where it pushes

    /// b [J].
    double
    value(const double d) const
    {
      const double s = d / width;
      if (s >= 1.)
        return 0.;
      if (!(s > 0.))
        return std::numeric_limits<double>::infinity();
      return -stiffness * width * (s - 1.) * (s - 1.) * std::log(s);
    }

    /// db/dd <= 0 [N].
    double
    slope(const double d) const
    {
      const double s = d / width;
      if (s >= 1.)
        return 0.;
      return -stiffness * (2. * (s - 1.) * std::log(s) + (s - 1.) * (s - 1.) / s);
    }

    /// d^2b/dd^2 >= 0 [N/m].
    double
    curvature(const double d) const
    {
      const double s = d / width;
      if (s >= 1.)
        return 0.;
      const double r = (s - 1.) / s;
      return -stiffness / width * (2. * std::log(s) + 4. * r - r * r);
    }
  };
} // namespace Exemplar

#endif
