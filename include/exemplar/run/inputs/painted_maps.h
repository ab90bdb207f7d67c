// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_painted_maps_h
#define exemplar_painted_maps_h

#include <exemplar/body/material.h>
#include <exemplar/run/inputs/surface_sources.h>

#include <vector>

namespace Exemplar
{
  /// The constants of the material that are painted on the surface. Throws UserError for values that
  /// they cannot have.
  PaintedMaterial
  read_painted_material(const SurfaceSources &from);

  /// Of Examples/Weight maps, a value a cell each. Throws UserError for values that are no shares.
  std::vector<std::vector<double>>
  read_painted_shares(const SurfaceSources &from);
} // namespace Exemplar

#endif
