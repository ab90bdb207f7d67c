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
    add_nodes(const SurfaceSources &from,
              const Selection      &selection,
              const std::string    &key,
              NamedNodes           &nodes)
    {
      if (selection.is_of_surface() && nodes.count(selection.text) == 0)
        nodes[selection.text] = from.selector.select(selection.text, key, from.inputs.maps);
    }

    void
    add_motion(const SurfaceSources   &from,
               const HandleParameters &handle,
               const std::string      &key,
               SurfaceReadings        &readings)
    {
      if (handle.follow_cache.empty())
        return;
      NamedNodes named = from.inputs.nodes;
      named.insert(readings.nodes.begin(), readings.nodes.end());
      readings.motions[handle.name]
          = motion_by_cache(from, handle, handle.select.choose(from.mesh, key, named));
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
    for (const HandleParameters &handle : scene.handles)
    {
      const std::string key = "Handles/" + handle.name + "/Select";
      add_nodes(from, handle.select, key, readings.nodes);
      add_motion(from, handle, key, readings);
    }
    for (const LoadParameters &load : scene.loads.named)
      add_nodes(from, load.select, "Loads/" + load.name + "/Select", readings.nodes);
    for (const auto &[selection, key] : scene.material.selections())
      add_nodes(from, selection, key, readings.nodes);
    return readings;
  }
} // namespace Exemplar
