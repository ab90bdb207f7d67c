// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_own_sheets_h
#define exemplar_own_sheets_h

#include <exemplar/surface/shape/closest_points.h>

#include <functional>
#include <optional>

namespace Exemplar
{
  /// Moves vertices that are carried by a sheet of the body which is not their own: where sheets
  /// touch or overlap at rest, a vertex at a rim is as near to the other one. An edge of the
  /// surface is broken if its ends are near, but their anchors are not. Vertices joined by unbroken
  /// edges are one sheet; the largest sheet of a connected part of the surface is taken to be
  /// right. The other vertices are moved one by one, each beside neighbours that are right, in each
  /// round in the order of the vertices. `is_broken(a, b)` tells whether an edge is broken;
  /// `move_beside(v, right)` gives vertex v an anchor beside those of `right`.
  void
  put_on_own_sheets(
      const SurfaceMesh                                                          &surface,
      const std::function<bool(unsigned int, unsigned int)>                      &is_broken,
      const std::function<void(unsigned int, const std::vector<unsigned int> &)> &move_beside);
} // namespace Exemplar

#endif
