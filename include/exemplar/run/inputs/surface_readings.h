// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_readings_h
#define exemplar_surface_readings_h

#include <exemplar/body/handles.h>
#include <exemplar/body/material.h>
#include <exemplar/run/inputs/inputs.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Data at nodes and cells that are read off the body's surface.
  struct SurfaceReadings
  {
    NamedNodes                       nodes;    ///< of selections, by their texts
    PaintedMaterial                  material; ///< empty: nothing is painted
    std::vector<std::vector<double>> shares;   ///< of Examples/Weight maps, a value a cell
    NamedMotions                     motions;  ///< of handles that follow a cache
    std::vector<std::string>         warnings;
  };

  /// Read all data that a scene takes off the surface among the inputs; the result is empty if it
  /// takes none. Throws UserError for selections without nodes, values out of range, damaged
  /// caches, and a surface that does not enclose the mesh.
  SurfaceReadings
  read_off_surface(const SceneParameters &scene, const Mesh &mesh, const Inputs &inputs);
} // namespace Exemplar

#endif
