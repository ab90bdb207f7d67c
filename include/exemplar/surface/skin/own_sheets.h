// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_own_sheets_h
#define exemplar_own_sheets_h

#include <exemplar/surface/shape/closest_points.h>

#include <functional>
#include <optional>

namespace Exemplar
{
  /// Vertices that a sheet of the body carries which is not their own: where sheets touch or overlap
  /// at rest, a vertex at a rim is as near to the other one. An edge of the surface is broken if its
  /// ends are near, but not what carries them. What unbroken edges join is one sheet; of a connected
  /// part of the surface the largest is taken for right. The others are given out one by one, each
  /// beside neighbours that are right, the first time in the order of the vertices.
  ///
  /// `is_broken(a, b)` tells of an edge; `move_beside(v, right)` gives vertex v a place beside those.
  void
  put_on_own_sheets(
      const SurfaceMesh                                                          &surface,
      const std::function<bool(unsigned int, unsigned int)>                      &is_broken,
      const std::function<void(unsigned int, const std::vector<unsigned int> &)> &move_beside);
} // namespace Exemplar

#endif
