// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_rigid_modes_h
#define exemplar_rigid_modes_h

#include <exemplar/algebra/exchange.h>

#include <vector>

// The near null space of a stiffness matrix, which the coarse spaces of multigrid must hold.

namespace Exemplar
{
  constexpr unsigned int n_rigid_modes = 6;

  /// Shift the origin of `places` (x, y, z of one node after the other) to the centroid of all
  /// nodes, and divide by their greatest coordinate, so that translations and rotations have the
  /// same order of magnitude. Each process has the places of its own nodes.
  void
  center_and_scale(std::vector<double> &places, const Exchange &exchange);

  /// Three translations and three infinitesimal rotations of the nodes at `places`, six columns of
  /// places.size() entries, one after the other. Entries whose row is not in `rows` are zero.
  std::vector<double>
  rigid_modes(const std::vector<double> &places, const std::vector<int> &rows);
} // namespace Exemplar

#endif
