// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_extent_h
#define exemplar_extent_h

#include <exemplar/algebra/exchange.h>

namespace Exemplar
{
  /// The greatest extent of a body along an axis [m]; positions are by degree of freedom. All
  /// processes must call this.
  double
  extent(const Vector &positions, const Exchange &exchange);
} // namespace Exemplar

#endif
