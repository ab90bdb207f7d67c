// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/map_name.h>
#include <exemplar/mesh/mesh_arrays.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/run/inputs/inputs.h>
#include <exemplar/run/inputs/shell_inputs.h>
#include <exemplar/run/scene/scene_parameters.h>
#include <exemplar/surface/shape/triangle_surface.h>

namespace Exemplar
{
  namespace
  {
    /// Whether the inside of Mesh/File is to be meshed.
    bool
    is_to_be_filled(const MeshParameters &mesh)
    {
      return mesh.is_surface() && mesh.generator == MeshGenerator::none;
    }

    /// Add the key to messages of exceptions of `act`.
    template <typename Action>
    auto
    under_key(const std::string &key, const Action &act)
    {
      try
      {
        return act();
      }
      catch (const UserError &error)
      {
        throw UserError(key + ": " + error.what());
      }
    }

    /// Reads the inputs that are missing.
    class InputReader
    {
    public:
      InputReader(const SceneParameters &scene, Inputs &inputs, const Announce &announce)
          : scene(scene), name(scene.mesh.name()), inputs(inputs), surfaces(scene, announce)
      {
      }

      void
      read()
      {
        if (!scene.mesh.file.empty() && (is_to_be_filled(scene.mesh) || inputs.mesh.nodes.empty()))
          under_key("Mesh/File",
                    [this]
                    {
                      require_file(scene.mesh.file,
                                   "a mesh (" + mesh_extensions
                                       + ", .geo) or of a surface (.obj, .ply or .stl)");
                    });
        if (inputs.mesh.nodes.empty())
          for (const std::string &file : scene.mesh.files)
            under_key("Mesh/Files",
                      [&] { require_file(file, "a mesh (" + mesh_extensions + ")"); });
        for_each_pose([this](const std::string &file) { check(file); });
        if (scene.examples.in_use() && !scene.examples.weights_file.empty()
            && inputs.weights.empty())
          inputs.weights = under_key(
              "Examples/Weights file",
              [this] { return read_weight_table(scene.examples.weights_file, scene.examples); });
        if (scene.needs_surface())
          add_surface();
        if (inputs.carried.empty())
          add_carried();
        for (const ObstacleParameters &obstacle : scene.obstacles.named)
          if ((!obstacle.surface_file().empty() || !obstacle.follow_track.empty())
              && inputs.obstacles.count(obstacle.name) == 0)
            inputs.obstacles[obstacle.name] = read_obstacle(obstacle);
        if (inputs.mesh.nodes.empty())
          inputs.mesh = is_shell()                    ? load_shell(scene.mesh)
                        : is_to_be_filled(scene.mesh) ? surfaces.make_mesh()
                                                      : load_mesh(scene.mesh);
        for (const auto &[selection, key] : scene.selections())
          add_nodes(selection.file(), key);
        for_each_pose([this](const std::string &file) { add(file); });
        inputs.made      = surfaces.get_made();
        inputs.geo_walls = inputs.mesh.geo_walls;
      }

    private:
      /// Call act(file, key) for each pose that the scene needs and the inputs lack.
      template <typename Action>
      void
      for_each_pose(const Action &act)
      {
        const auto act_on_missing = [&](const std::string &file, const std::string &key)
        {
          if (!file.empty() && inputs.poses.count(file) == 0)
            under_key(key, [&] { act(file); });
        };
        for (const HandleParameters &handle : scene.handles)
        {
          act_on_missing(handle.follow_pose, "Handles/" + handle.name + "/Follow pose");
          require_same_unit(handle.follow_pose, "Handles/" + handle.name + "/Follow pose");
        }
        if (scene.examples.in_use())
          for (const std::string &pose : scene.examples.poses)
            act_on_missing(pose, "Examples/Poses");
        act_on_missing(scene.initial.pose, "Initial/Pose");
      }

      /// Throws UserError for a pose that is read and so large that its unit of length is another one.
      void
      require_same_unit(const std::string &file, const std::string &key) const
      {
        constexpr double greatest = 100.;
        const auto       pose     = inputs.poses.find(file);
        if (pose == inputs.poses.end() || inputs.mesh.nodes.empty())
          return; // handed in
        if (const double ratio = box_diagonal(pose->second) / box_diagonal(inputs.mesh.nodes);
            ratio > greatest)
          throw UserError(key + ": " + file + " is " + short_text(ratio)
                          + " times as large as the body. Write both in the same unit of length.");
      }

      void
      check(const std::string &file)
      {
        require_file(file, "a pose: a mesh (" + mesh_extensions + "), or a surface",
                     is_surface_file(file) ? scene.mesh.surface_file() : scene.mesh.file);
        if (is_surface_file(file) && !is_shell())
          surfaces.read_pose(file);
      }

      bool
      is_shell() const
      {
        return scene.mesh.kind == MeshKind::shell;
      }

      void
      add(const std::string &file)
      {
        std::string note;
        inputs.poses[file] = is_shell()              ? read_shell_pose(file, inputs.mesh, name)
                             : is_surface_file(file) ? surfaces.carry(file, inputs.mesh)
                                                     : read_pose(file, inputs.mesh, name, &note);
        if (!note.empty())
          inputs.mesh.note += (inputs.mesh.note.empty() ? "" : " ") + file + ": " + note;
      }

      void
      add_nodes(const std::string &file, const std::string &key)
      {
        if (!file.empty() && inputs.nodes.count(file) == 0)
          inputs.nodes[file] = read_nodes(file, inputs.mesh, name, key);
      }

      /// Read the surface, its maps and the caches that move handles.
      void
      add_surface()
      {
        if (inputs.surface == nullptr)
          inputs.surface
              = std::make_shared<const SurfaceMesh>(read_surface(scene.mesh.surface_file()));
        add_map(scene.material.youngs_modulus_map, "Material/Young's modulus map");
        add_map(scene.material.poissons_ratio_map, "Material/Poisson's ratio map");
        add_map(scene.material.density_map, "Material/Density map");
        add_map(scene.material.thickness_map, "Material/Thickness map");
        add_map(scene.material.importance_map, "Material/Importance map");
        add_map(scene.material.fibre_tension_map, "Material/Fibre tension map");
        for (const std::string &map : scene.material.fibre_direction_maps)
          add_map(map, "Material/Fibre direction maps");
        if (scene.examples.are_painted())
          for (const std::string &map : scene.examples.weight_maps)
            add_map(map, "Examples/Weight maps");
        for (const HandleParameters &handle : scene.handles)
          if (!handle.follow_cache.empty() && inputs.caches.count(handle.name) == 0)
            inputs.caches[handle.name]
                = under_key("Handles/" + handle.name + "/Follow cache",
                            [&]
                            {
                              return open_point_cache(handle.follow_cache, handle.frames_per_second,
                                                      *inputs.surface, scene.mesh.surface_file());
                            });
        for (const auto &[selection, key] : scene.selections())
          add_map(selection.map(), key);
      }

      void
      add_carried()
      {
        for (const std::string &file : scene.mesh.carried)
          under_key("Mesh/Carry",
                    [&]
                    {
                      require_file(file, "a surface: an .obj, .ply or .stl file");
                      inputs.carried.push_back({ name_of_carried(file), read_surface(file) });
                    });
      }

      /// What files say of an obstacle.
      static ObstacleSurface
      read_obstacle(const ObstacleParameters &obstacle)
      {
        const std::string key  = "Obstacles/" + obstacle.name;
        const std::string file = obstacle.surface_file();
        ObstacleSurface   result;
        if (!obstacle.follow_track.empty())
          result.track = under_key(key + "/Follow track",
                                   [&] { return read_rigid_track(obstacle.follow_track); });
        if (file.empty())
          return result;
        under_key(key + "/Shape",
                  [&]
                  {
                    require_file(file, "a surface: an .obj, .ply or .stl file");
                    const SurfaceMesh     mesh    = read_surface(file);
                    const TriangleSurface surface = triangulate(mesh);
                    result.vertices               = surface.vertices;
                    result.triangles              = surface.triangles;
                    if (obstacle.follow_cache.empty())
                      return;
                    const auto cache = open_point_cache(obstacle.follow_cache,
                                                        obstacle.frames_per_second, mesh, file);
                    result.times     = cache->get_times();
                    for (std::size_t k = 0; k < result.times.size(); ++k)
                      result.samples.push_back(cache->sample(k));
                  });
        return result;
      }

      void
      add_map(const std::string &text, const std::string &key)
      {
        if (text.empty())
          return;
        const MapName map = split_map_name(text, key);
        if (inputs.maps.count(map.name()) == 0)
          inputs.maps[map.name()]
              = under_key(key,
                          [&] {
                            return read_painted_map(map.file, map.attribute, *inputs.surface,
                                                    scene.mesh.surface_file());
                          });
      }

      const SceneParameters &scene;
      const std::string      name;
      Inputs                &inputs;
      SurfaceInputs          surfaces;
    };
  } // namespace

  Inputs
  read_inputs(const CompleteScene &scene, Inputs given, const Announce &announce)
  {
    InputReader(scene, given, announce).read();
    return given;
  }

  MshFile
  load_or_make_mesh(const MeshParameters &parameters)
  {
    SceneParameters scene;
    scene.mesh = parameters;
    if (parameters.kind == MeshKind::shell)
      return load_shell(parameters);
    return is_to_be_filled(parameters) ? SurfaceInputs(scene, {}).make_mesh()
                                       : load_mesh(parameters);
  }
} // namespace Exemplar
