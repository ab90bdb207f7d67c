// SPDX-License-Identifier: GPL-3.0-or-later
// Format: Khronos Group, "glTF 2.0 Specification", version 2.0.1 (2021).
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/base/version.h>
#include <exemplar/exemplar.h>
#include <exemplar/live/export_gltf.h>
#include <exemplar/live/keyed_shapes.h>
#include <exemplar/live/rigid_parts.h>
#include <exemplar/run/frames/raw_bytes.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/surface/files/material_library.h>
#include <exemplar/surface/shape/triangle_surface.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    using Json = nlohmann::json;

    /// Ends the buffer, where nothing refers to it, so that files of ours are recognised.
    const std::string mark_at_end = "written by exemplar export..";

    const std::string magic("glTF\2\0\0\0", 8);

    void
    require_gltf(const fs::path &file)
    {
      const std::string remedy = " Give another name by --gltf.";
      if (file.extension() != ".glb")
        throw UserError("--gltf: a binary glTF is written, found " + in_quotes(file.string())
                        + ". Give a name that ends in .glb.");
      const fs::path parent = fs::absolute(file).parent_path();
      if (!fs::is_directory(parent))
        throw UserError(parent.string()
                        + " is no directory. Make it, or give another name by --gltf.");
      require_replaceable({ file, magic, mark_at_end }, {}, remedy);
    }

    enum class ViewTarget
    {
      none       = 0,
      attributes = 34962,
      indices    = 34963
    };

    /// The buffer of a file, and what tells its parts.
    class GltfBuffer
    {
    public:
      /// Returns the number of the view.
      std::size_t
      add_view(const std::string &part, const ViewTarget target)
      {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        views.push_back(
            { { "buffer", 0 }, { "byteOffset", bytes.size() }, { "byteLength", part.size() } });
        if (target != ViewTarget::none)
          views.back()["target"] = static_cast<int>(target);
        bytes += part;
        return views.size() - 1;
      }

      /// Returns the number of the accessor; `type` has `n_components` numbers.
      std::size_t
      add_floats(const std::vector<float> &numbers,
                 const std::string        &type,
                 const std::size_t         n_components,
                 const bool                with_bounds,
                 const ViewTarget          target)
      {
        std::string part;
        for (const float number : numbers)
        {
          if (!std::isfinite(number))
            throw UserError("The run holds numbers that no glTF can hold. Look at its frames.");
          append_raw<ByteOrder::little>(part, number);
        }
        accessors.push_back({ { "bufferView", add_view(part, target) },
                              { "componentType", 5126 },
                              { "type", type },
                              { "count", numbers.size() / n_components } });
        if (with_bounds)
          add_bounds(numbers, n_components);
        return accessors.size() - 1;
      }

      std::size_t
      add_indices(const std::vector<std::uint32_t> &indices)
      {
        std::string part;
        for (const std::uint32_t index : indices)
          append_raw<ByteOrder::little>(part, index);
        accessors.push_back({ { "bufferView", add_view(part, ViewTarget::indices) },
                              { "componentType", 5125 },
                              { "type", "SCALAR" },
                              { "count", indices.size() } });
        return accessors.size() - 1;
      }

      std::string bytes;
      Json        views = Json::array(), accessors = Json::array();

    private:
      void
      add_bounds(const std::vector<float> &numbers, const std::size_t n_components)
      {
        for (std::size_t c = 0; c < n_components; ++c)
        {
          float least = numbers[c], greatest = numbers[c];
          for (std::size_t i = c; i < numbers.size(); i += n_components)
          {
            least    = std::min(least, numbers[i]);
            greatest = std::max(greatest, numbers[i]);
          }
          accessors.back()["min"].push_back(least);
          accessors.back()["max"].push_back(greatest);
        }
      }
    };

    /// The vertices of a surface in its order, then copies of those that have several texture points, and the triangles of
    /// each material, all on the same vertices.
    class SharedVertices
    {
    public:
      static constexpr unsigned int no_texture = static_cast<unsigned int>(-1);

      struct Vertex
      {
        unsigned int number; ///< in the surface
        unsigned int texture = no_texture;
      };

      explicit SharedVertices(const SurfaceMesh &surface)
      {
        for (unsigned int v = 0; v < surface.vertices.size(); ++v)
          vertices.push_back({ v });
        std::vector<unsigned int> polygons;
        const TriangleSurface     triangles = triangulate(surface, &polygons);
        const auto                names     = material_names(surface);
        for (std::size_t t = 0; t < triangles.triangles.size(); ++t)
          for (const unsigned int vertex : triangles.triangles[t])
            indices[names[polygons[t]]].push_back(
                number_of(vertex, texture_at(surface, polygons[t], vertex), surface));
      }

      bool
      have_texture() const
      {
        return !copies.empty();
      }

      std::vector<Vertex>                               vertices;
      std::map<std::string, std::vector<std::uint32_t>> indices; ///< by material

    private:
      static unsigned int
      texture_at(const SurfaceMesh &surface, const unsigned int face, const unsigned int vertex)
      {
        if (surface.face_texture_points.empty() || surface.face_texture_points[face].empty())
          return no_texture;
        const auto &corners = surface.faces[face];
        return surface.face_texture_points[face][std::find(corners.begin(), corners.end(), vertex)
                                                 - corners.begin()];
      }

      /// The vertex at this place of its texture, which files may hold once per corner; the first one of each keeps the
      /// number of the surface.
      std::uint32_t
      number_of(const unsigned int vertex, const unsigned int texture, const SurfaceMesh &surface)
      {
        if (texture == no_texture)
          return vertex;
        const auto [copy, is_new]
            = copies.emplace(std::make_pair(vertex, surface.texture_points[texture]), vertex);
        if (is_new && vertices[vertex].texture == no_texture)
          vertices[vertex].texture = texture;
        else if (is_new)
        {
          copy->second = vertices.size();
          vertices.push_back({ vertex, texture });
        }
        return copy->second;
      }

      std::map<std::pair<unsigned int, std::array<double, 2>>, std::uint32_t> copies;
    };

    class GltfMaker
    {
    public:
      GltfMaker(const RunMotion              &motion,
                const KeyedShapes            &shapes,
                const std::vector<RigidPart> &obstacles,
                const fs::path               &run)
          : motion(motion), shapes(shapes), obstacles(obstacles), run(run)
      {
        for (std::size_t i = 0; i < shapes.n_shapes(); ++i)
          names.push_back(fmt::format("shape {}", i + 1));
        names.insert(names.begin(), motion.names.begin(), motion.names.end());
      }

      /// The bytes of the file.
      std::string
      make()
      {
        Json document
            = { { "asset",
                  { { "version", "2.0" }, { "generator", "exemplar " EXEMPLAR_VERSION } } },
                { "scene", 0 },
                { "scenes", { { { "nodes", { 0 } } } } } };
        // node 0 turns z up to y, node 1 moves rigidly, the others show the surfaces
        Json nodes = { { { "name", "run" }, { "children", { 1 } } },
                       { { "name", "motion" }, { "children", Json::array() } } };
        if (motion.z_is_up)
        {
          const float half     = std::sqrt(0.5F);
          nodes[0]["rotation"] = { -half, 0., 0., half };
        }
        Json meshes = Json::array();
        for (const MovingSurface &moving : motion.surfaces)
        {
          nodes[1]["children"].push_back(nodes.size());
          nodes.push_back({ { "name", moving.name }, { "mesh", meshes.size() } });
          meshes.push_back(mesh_of(moving));
        }
        const std::size_t n_moving = nodes.size();
        for (std::size_t i = 0; i < obstacles.size(); ++i)
        {
          nodes[0]["children"].push_back(nodes.size());
          nodes.push_back({ { "name", name_of_obstacle(i) }, { "mesh", meshes.size() } });
          meshes.push_back(mesh_of(obstacles[i], name_of_obstacle(i)));
        }
        document["animations"] = { animation(n_moving) };
        document["nodes"]      = std::move(nodes);
        document["meshes"]     = std::move(meshes);
        for (const auto &[key, list] :
             { std::make_pair("materials", materials), std::make_pair("textures", textures),
               std::make_pair("images", images) })
          if (!list.empty())
            document[key] = list;
        return file_of(document);
      }

      std::vector<std::string> notes;
      std::size_t              n_copies = 0; ///< of vertices at seams of textures

    private:
      using Numbers = std::vector<float>;

      std::size_t
      add_places(const Places         &places,
                 const MovingSurface  &moving,
                 const SharedVertices &shared,
                 const bool            with_bounds)
      {
        Numbers numbers;
        for (const auto &vertex : shared.vertices)
          for (unsigned int c = 0; c < 3; ++c)
            numbers.push_back(static_cast<float>(places[moving.first_in_list + vertex.number][c]));
        return buffer.add_floats(numbers, "VEC3", 3, with_bounds, ViewTarget::attributes);
      }

      /// A primitive without its triangles.
      Json
      primitive_of(const MovingSurface &moving, const SharedVertices &shared)
      {
        const bool with_normals = !shapes.rest_normals.empty();
        Json       primitive;
        Json      &attributes  = primitive["attributes"];
        attributes["POSITION"] = add_places(shapes.rest, moving, shared, true);
        if (with_normals)
          attributes["NORMAL"] = add_places(shapes.rest_normals, moving, shared, false);
        if (shared.have_texture())
          attributes["TEXCOORD_0"] = add_texture_points(moving.surface, shared);
        for (std::size_t i = 0; i < shapes.targets.size(); ++i)
        {
          Json target = { { "POSITION", add_places(shapes.targets[i], moving, shared, true) } };
          if (with_normals)
            target["NORMAL"] = add_places(shapes.target_normals[i], moving, shared, false);
          primitive["targets"].push_back(target);
        }
        return primitive;
      }

      std::size_t
      add_texture_points(const SurfaceMesh &surface, const SharedVertices &shared)
      {
        Numbers numbers;
        for (const auto &vertex : shared.vertices)
        {
          const bool is_there = vertex.texture != SharedVertices::no_texture;
          const auto point    = is_there ? surface.texture_points[vertex.texture]
                                         : std::array<double, 2>{ { 0., 1. } };
          numbers.push_back(static_cast<float>(point[0]));
          numbers.push_back(static_cast<float>(1. - point[1])); // down in glTF
        }
        return buffer.add_floats(numbers, "VEC2", 2, false, ViewTarget::attributes);
      }

      Json
      mesh_of(const MovingSurface &moving)
      {
        const MaterialLibraries libraries
            = read_material_libraries(moving.surface, { run, moving.folder });
        for (const std::string &library : libraries.missing)
          notes.push_back("The material library " + in_quotes(library) + " of " + moving.name
                          + " is missing: copy it into the run's directory.");
        Json mesh = { { "name", moving.name } };
        if (!shapes.targets.empty())
        {
          mesh["extras"]["targetNames"] = names;
          mesh["weights"]               = Numbers(names.size(), 0.F);
        }
        const SharedVertices shared(moving.surface);
        const Json           on_all = primitive_of(moving, shared);
        n_copies += shared.vertices.size() - moving.surface.vertices.size();
        for (const auto &[name, indices] : shared.indices)
        {
          Json primitive       = on_all;
          primitive["indices"] = buffer.add_indices(indices);
          if (!name.empty() || !moving.is_of_body) // what is worn may be seen from inside
          {
            primitive["material"] = materials.size();
            materials.push_back(
                material_of(name.empty() ? moving.name : name, libraries.materials, name));
            if (!moving.is_of_body)
              materials.back()["doubleSided"] = true;
          }
          mesh["primitives"].push_back(primitive);
        }
        return mesh;
      }

      std::string
      name_of_obstacle(const std::size_t i) const
      {
        const auto &names = motion.names_of_obstacles;
        return names.size() == obstacles.size() ? names[i] : fmt::format("obstacle {}", i + 1);
      }

      Json
      mesh_of(const RigidPart &obstacle, const std::string &name)
      {
        Numbers                    places;
        std::vector<std::uint32_t> indices;
        for (const auto &x : obstacle.vertices)
          for (unsigned int c = 0; c < 3; ++c)
            places.push_back(static_cast<float>(x[c]));
        for (const auto &triangle : obstacle.triangles)
          indices.insert(indices.end(), triangle.begin(), triangle.end());
        Json primitive = { { "indices", buffer.add_indices(indices) },
                           { "material", material_of_obstacles() } };
        primitive["attributes"]["POSITION"]
            = buffer.add_floats(places, "VEC3", 3, true, ViewTarget::attributes);
        return { { "name", name }, { "primitives", { primitive } } };
      }

      /// The number of the one material of all obstacles: grey, seen from both sides.
      std::size_t
      material_of_obstacles()
      {
        if (!grey)
        {
          grey = materials.size();
          materials.push_back({ { "name", "obstacles" }, { "doubleSided", true } });
          materials.back()["pbrMetallicRoughness"] = { { "baseColorFactor", { 0.5, 0.5, 0.5, 1. } },
                                                       { "metallicFactor", 0. },
                                                       { "roughnessFactor", 0.8 } };
        }
        return *grey;
      }

      Json
      material_of(const std::string                            &shown,
                  const std::map<std::string, SurfaceMaterial> &known,
                  const std::string                            &name)
      {
        Json       json  = { { "name", shown } };
        const auto found = known.find(name);
        if (found == known.end())
          return json;
        const SurfaceMaterial &material = found->second;
        auto                   colour   = material.colour;
        Json                  &surface  = json["pbrMetallicRoughness"];
        if (material.texture)
          if (const auto texture = add_texture(*material.texture))
          {
            surface["baseColorTexture"]["index"] = *texture;
            colour                               = { { 1., 1., 1. } };
          }
        surface["baseColorFactor"] = { colour[0], colour[1], colour[2], material.opacity };
        surface["metallicFactor"]  = 0.;
        surface["roughnessFactor"] = 1. - std::sqrt(material.exponent / 1000.);
        if (material.opacity < 1.)
          json["alphaMode"] = "BLEND";
        if (material.emission != std::array<double, 3>{ { 0., 0., 0. } })
          json["emissiveFactor"] = material.emission;
        return json;
      }

      /// The number of an image's texture; nothing for a file that is none that glTF knows.
      std::optional<std::size_t>
      add_texture(const fs::path &file)
      {
        std::error_code none;
        const auto bytes = fs::is_regular_file(file, none) ? read_text_file(file) : std::nullopt;
        const std::string begin = bytes ? bytes->substr(0, 4) : "";
        const bool is_png = begin == "\x89PNG", is_jpeg = begin.substr(0, 3) == "\xff\xd8\xff";
        if (!is_png && !is_jpeg)
        {
          notes.push_back(in_quotes(file.string())
                          + " is no PNG or JPEG, which glTF holds: it is left out.");
          return std::nullopt;
        }
        const auto known = texture_of.find(file);
        if (known != texture_of.end())
          return known->second;
        images.push_back({ { "name", file.stem().string() },
                           { "mimeType", is_png ? "image/png" : "image/jpeg" },
                           { "bufferView", buffer.add_view(*bytes, ViewTarget::none) } });
        textures.push_back({ { "source", images.size() - 1 } });
        return texture_of[file] = textures.size() - 1;
      }

      Json
      animation(const std::size_t n_nodes)
      {
        Numbers times, rotations, translations, weights;
        for (const double time : motion.times)
          times.push_back(static_cast<float>(time));
        for (const ShapeKey &key : shapes.keys)
        {
          rotations.insert(rotations.end(), key.rotation.begin(), key.rotation.end());
          translations.insert(translations.end(), key.translation.begin(), key.translation.end());
          weights.insert(weights.end(), key.weights.begin(), key.weights.end());
        }
        const auto input = buffer.add_floats(times, "SCALAR", 1, true, ViewTarget::none);
        Json       result
            = { { "name", "run" }, { "samplers", Json::array() }, { "channels", Json::array() } };
        const auto add_sampler
            = [&](const Numbers &numbers, const std::string &type, const std::size_t n)
        {
          result["samplers"].push_back(
              { { "input", input },
                { "output", buffer.add_floats(numbers, type, n, false, ViewTarget::none) },
                { "interpolation", "LINEAR" } });
        };
        const auto add_channel
            = [&](const std::size_t sampler, const std::size_t node, const std::string &path)
        {
          result["channels"].push_back(
              { { "sampler", sampler }, { "target", { { "node", node }, { "path", path } } } });
        };
        add_sampler(rotations, "VEC4", 4);
        add_channel(0, 1, "rotation");
        add_sampler(translations, "VEC3", 3);
        add_channel(1, 1, "translation");
        if (!weights.empty())
          add_sampler(weights, "SCALAR", 1);
        for (std::size_t node = 2; !weights.empty() && node < n_nodes; ++node)
          add_channel(2, node, "weights");
        for (std::size_t i = 0; i < obstacles.size(); ++i)
        {
          Numbers turns, places, sizes;
          for (const RigidPart::Key &key : obstacles[i].keys)
          {
            turns.insert(turns.end(), key.rotation.begin(), key.rotation.end());
            places.insert(places.end(), key.translation.begin(), key.translation.end());
            sizes.insert(sizes.end(), 3, key.size);
          }
          add_sampler(turns, "VEC4", 4);
          add_channel(result["samplers"].size() - 1, n_nodes + i, "rotation");
          add_sampler(places, "VEC3", 3);
          add_channel(result["samplers"].size() - 1, n_nodes + i, "translation");
          if (std::find(sizes.begin(), sizes.end(), 0.F) == sizes.end())
            continue; // it is always there
          add_sampler(sizes, "VEC3", 3);
          add_channel(result["samplers"].size() - 1, n_nodes + i, "scale");
        }
        return result;
      }

      std::string
      file_of(Json &document)
      {
        buffer.bytes.resize((buffer.bytes.size() + 3) / 4 * 4);
        buffer.bytes += mark_at_end;
        document["buffers"]     = { { { "byteLength", buffer.bytes.size() } } };
        document["bufferViews"] = buffer.views;
        document["accessors"]   = buffer.accessors;
        std::string text        = document.dump(-1, ' ', false, Json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::size_t size = 12 + 8 + text.size() + 8 + buffer.bytes.size();
        if (size > std::numeric_limits<std::uint32_t>::max())
          throw UserError("A binary glTF holds 4 GB at most. Write fewer frames, by Output/Every, "
                          "or fewer shapes, by --shapes.");
        std::string file = magic;
        append_raw<ByteOrder::little>(file, static_cast<std::uint32_t>(size));
        append_raw<ByteOrder::little>(file, static_cast<std::uint32_t>(text.size()));
        file += "JSON" + text;
        append_raw<ByteOrder::little>(file, static_cast<std::uint32_t>(buffer.bytes.size()));
        file += std::string("BIN\0", 4) + buffer.bytes;
        return file;
      }

      const RunMotion              &motion;
      const KeyedShapes            &shapes;
      const std::vector<RigidPart> &obstacles;
      const fs::path                run;
      std::vector<std::string>      names; ///< of the targets
      GltfBuffer                    buffer;
      Json materials = Json::array(), textures = Json::array(), images = Json::array();
      std::map<fs::path, std::size_t> texture_of;
      std::optional<std::size_t>      grey; ///< the material of obstacles
    };

    constexpr std::size_t supported_attributes = 8; ///< of targets, by all viewers
  }                                                 // namespace

  GltfReport
  export_gltf(const GltfOptions &options)
  {
    require_gltf(options.file);
    const RunMotion   motion = motion_of_run(options.run);
    const KeyedShapes shapes = keyed_shapes(motion, options.n_shapes, options.with_normals);
    GltfReport        report;
    report.warnings = motion.notes;
    const std::vector<RigidPart> obstacles
        = rigid_obstacles(motion, default_error_in_contact * shapes.diagonal, report.warnings);
    GltfMaker         maker(motion, shapes, obstacles, options.run);
    const std::string bytes      = maker.make();
    bool              is_clamped = false;
    report.n_frames              = motion.frames.size();
    report.n_vertices            = motion.rest.size();
    report.n_copies              = maker.n_copies;
    report.n_examples            = shapes.n_examples;
    report.n_shapes              = shapes.n_shapes();
    report.n_bytes               = bytes.size();
    report.error                 = shapes.error;
    report.relative_error        = shapes.error / shapes.diagonal;
    report.n_obstacles           = obstacles.size();
    if (motion.has_contact)
      report.crossings = crossings_of(motion, shapes);
    report.warnings.insert(report.warnings.end(), maker.notes.begin(), maker.notes.end());
    if (const std::size_t n = shapes.targets.size(); n > supported_attributes)
      report.warnings.push_back(
          fmt::format("There are {} morph targets. The standard asks viewers for {}: look whether "
                      "yours shows all, or take fewer by --shapes.",
                      n, supported_attributes));
    for (const auto &weights : motion.weights)
      for (const double weight : weights)
        if (weight < -1e-6 || weight > 1. + 1e-6)
          is_clamped = true;
    if (is_clamped)
      report.warnings.push_back(
          "Some weights of examples are less than 0 or greater than 1, which "
          "Blender's importer clamps. Take Examples/Weights = simplex or additive.");
    AtomicFile out(options.file);
    out.stream() << bytes;
    out.commit();
    return report;
  }
} // namespace Exemplar::Live
