// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/inputs/cache_motion.h>
#include <exemplar/run/inputs/painted_maps.h>
#include <exemplar/run/inputs/surface_readings.h>

namespace Exemplar
{
  namespace
  {
    void
    add_motion(const SurfaceSources   &from,
               const HandleParameters &handle,
               SurfaceReadings        &readings)
    {
      if (handle.follow_cache.empty())
        return;
      NamedNodes named = from.inputs.nodes;
      named.insert(readings.nodes.begin(), readings.nodes.end());
      readings.motions[handle.name] = motion_by_cache(
          from, handle,
          handle.select.choose(from.mesh, "Handles/" + handle.name + "/Select", named));
    }
  } // namespace

  SurfaceReadings
  read_off_surface(const SceneParameters &scene, const Mesh &mesh, const Inputs &inputs)
  {
    if (!scene.reads_off_surface())
      return {};
    if (inputs.surface == nullptr)
      throw UserError("Mesh/Surface: the scene needs the surface of the body, but there is none "
                      "among the inputs. Hand it in, or read it from its file.");
    const SurfaceSelector selector(mesh, *inputs.surface, scene.mesh.scale,
                                   scene.mesh.surface_file());
    SurfaceReadings       readings;
    const SurfaceSources  from{ scene, mesh, inputs, selector, readings.warnings };
    readings.material = read_painted_material(from);
    readings.shares   = read_painted_shares(from);
    for (const auto &[selection, key] : scene.selections())
      if (selection.is_of_surface() && readings.nodes.count(selection.text) == 0)
        readings.nodes[selection.text] = selector.select(selection.text, key, inputs.maps);
    for (const HandleParameters &handle : scene.handles)
      add_motion(from, handle, readings);
    return readings;
  }
} // namespace Exemplar
