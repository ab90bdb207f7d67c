// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_rigid_modes_h
#define exemplar_rigid_modes_h

#include <exemplar/algebra/exchange.h>

#include <vector>

// The near null space of a stiffness matrix, which the coarse spaces of multigrid must hold.

namespace Exemplar
{
  constexpr unsigned int n_rigid_modes = 6;

  /// Move the nodes at `places` (x, y, z of one after the other) to their centroid and divide them
  /// by their greatest coordinate, so that translations and rotations are of the same size. Each
  /// process has the places of other nodes.
  void
  center_and_scale(std::vector<double> &places, const Exchange &exchange);

  /// Three translations and three infinitesimal rotations of the nodes at `places`, a column of
  /// places.size() entries each, one after the other. Entries whose row is not in `rows` are zero.
  std::vector<double>
  rigid_modes(const std::vector<double> &places, const std::vector<int> &rows);
} // namespace Exemplar

#endif
