// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_regions_h
#define exemplar_regions_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/region_shares.h>

#include <vector>

// Regions of a body of cells; the shares are the same at all quadrature points of a cell.

namespace Exemplar
{
  /// Regions by material id of the whole mesh. Without a blend length [m] a cell belongs to its own
  /// region alone. With one, shares change smoothly over about this distance, measured inside the
  /// body: they solve s - l^2 Laplace s = indicator of the region, with natural boundary conditions
  /// and l = blend_length / (2 sqrt 3), the filter of Lazarov and Sigmund 2011, on linear elements;
  /// only for a single process.
  RegionShares
  regions_of_materials(const Mesh &mesh, double blend_length, unsigned int points_per_cell = 1);

  /// Painted regions: for each of them, from number 1 on, its map's value in every cell. Where values
  /// sum to more than one they are divided by their sum; where they sum to less, the rest belongs to
  /// region 0, which exists only if there is a rest anywhere. Throws UserError for a map that is zero
  /// everywhere. Collective.
  RegionShares
  painted_regions(const std::vector<std::vector<double>> &painted,
                  unsigned int                            points_per_cell = 1,
                  const Exchange                         &exchange        = Exchange::serial());
} // namespace Exemplar

#endif
