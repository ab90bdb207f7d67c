// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_sources_h
#define exemplar_surface_sources_h

#include <exemplar/run/inputs/inputs.h>
#include <exemplar/run/scene/scene_parameters.h>
#include <exemplar/surface/skin/surface_selector.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Where data on the surface of a body are read from.
  struct SurfaceSources
  {
    const SceneParameters    &scene;
    const Mesh               &mesh;
    const Inputs             &inputs;
    const SurfaceSelector    &selector;
    std::vector<std::string> &warnings; ///< appended to
  };
} // namespace Exemplar

#endif
