// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_single_precision_h
#define exemplar_single_precision_h

#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>

#include <limits>

namespace Exemplar
{
  /// A coordinate in the single precision of graphics formats. Throws SolverFailure if it
  /// overflows.
  inline float
  single_precision(const double coordinate)
  {
    if (!(std::abs(coordinate) <= std::numeric_limits<float>::max()))
      throw SolverFailure("A vertex of the surface is at " + short_text(coordinate)
                          + ", which point caches and USD cannot hold. Take smaller steps, look at "
                            "what handles, loads and Initial do, or scale the files.");
    return static_cast<float>(coordinate);
  }
} // namespace Exemplar

#endif
