// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
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
        const std::string file = selection.file();
        if (!file.empty() && inputs.nodes.count(file) == 0)
          inputs.nodes[file] = read_nodes(file, inputs.mesh, name, key + "/Select");
      }

    private:
      const std::string name;
      Inputs           &inputs;
    };
  } // namespace

  Inputs
  read_inputs(SceneParameters scene, Inputs given)
  {
    scene.complete();
    InputReader reader(scene.mesh, given);
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
    if (scene.needs_surface() && given.surface == nullptr)
      given.surface = std::make_shared<const SurfaceMesh>(read_surface(scene.mesh.surface_file()));
    return given;
  }
} // namespace Exemplar
