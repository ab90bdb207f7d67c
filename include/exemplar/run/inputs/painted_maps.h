// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_painted_maps_h
#define exemplar_painted_maps_h

#include <exemplar/body/material.h>
#include <exemplar/run/inputs/surface_sources.h>

#include <vector>

namespace Exemplar
{
  /// The material's constants painted on the surface. Throws UserError for values out of range.
  PaintedMaterial
  read_painted_material(const SurfaceSources &from);

  /// Shares by Examples/Weight maps, a value a cell in each. Throws UserError for values outside
  /// [0, 1].
  std::vector<std::vector<double>>
  read_painted_shares(const SurfaceSources &from);
} // namespace Exemplar

#endif
