// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/map_name.h>
#include <exemplar/run/inputs.h>
#include <exemplar/run/scene_parameters.h>

namespace Exemplar
{
  namespace
  {
    /// Adds to inputs what they do not hold.
    class InputReader
    {
    public:
      InputReader(const MeshParameters &mesh, Inputs &inputs) : name(mesh.name()), inputs(inputs)
      {
        if (inputs.mesh.nodes.empty())
          inputs.mesh = load_mesh(mesh);
      }

      void
      add_pose(const std::string &file)
      {
        if (!file.empty() && inputs.poses.count(file) == 0)
          inputs.poses[file] = read_pose(file, inputs.mesh, name);
      }

      void
      add_followed_pose(const HandleParameters &handle)
      {
        try
        {
          add_pose(handle.follow_pose);
        }
        catch (const UserError &error)
        {
          throw UserError("Handles/" + handle.name + "/Follow pose: " + error.what());
        }
      }

      void
      add_nodes(const Selection &selection, const std::string &key)
      {
        if (!selection.map().empty())
          add_map(selection.map(), key + "/Select");
        const std::string file = selection.file();
        if (!file.empty() && inputs.nodes.count(file) == 0)
          inputs.nodes[file] = read_nodes(file, inputs.mesh, name, key + "/Select");
      }

      void
      add_surface(const std::string &file)
      {
        surface_name = file;
        if (inputs.surface == nullptr)
          inputs.surface = std::make_shared<const SurfaceMesh>(read_surface(file));
      }

      void
      add_map(const std::string &text, const std::string &key)
      {
        if (text.empty())
          return;
        const MapName map = split_map_name(text, key);
        if (inputs.maps.count(map.name()) == 0)
          inputs.maps[map.name()]
              = read_painted_map(map.file, map.attribute, *inputs.surface, surface_name);
      }

      void
      add_cache(const HandleParameters &handle)
      {
        if (!handle.follow_cache.empty() && inputs.caches.count(handle.name) == 0)
          inputs.caches[handle.name] = open_point_cache(
              handle.follow_cache, handle.frames_per_second, *inputs.surface, surface_name);
      }

    private:
      const std::string name;
      Inputs           &inputs;
      std::string       surface_name;
    };

    void
    add_maps(const SceneParameters &scene, InputReader &reader)
    {
      const MaterialParameters &material = scene.material;
      reader.add_map(material.youngs_modulus_map, "Material/Young's modulus map");
      reader.add_map(material.poissons_ratio_map, "Material/Poisson's ratio map");
      reader.add_map(material.density_map, "Material/Density map");
      if (scene.examples.are_painted())
        for (const std::string &map : scene.examples.weight_maps)
          reader.add_map(map, "Examples/Weight maps");
      for (const HandleParameters &handle : scene.handles)
        reader.add_cache(handle);
    }
  } // namespace

  Inputs
  read_inputs(SceneParameters scene, Inputs given)
  {
    scene.complete();
    InputReader reader(scene.mesh, given);
    if (scene.needs_surface())
      reader.add_surface(scene.mesh.surface_file());
    for (const HandleParameters &handle : scene.handles)
    {
      reader.add_nodes(handle.select, "Handles/" + handle.name);
      reader.add_followed_pose(handle);
    }
    for (const LoadParameters &load : scene.loads.named)
      reader.add_nodes(load.select, "Loads/" + load.name);
    if (scene.examples.in_use())
      for (const std::string &pose : scene.examples.poses)
        reader.add_pose(pose);
    reader.add_pose(scene.initial.pose);
    add_maps(scene, reader);
    return given;
  }
} // namespace Exemplar
