// SPDX-License-Identifier: GPL-3.0-or-later
// Format: OpenUSD, "USDA file format" and schemas UsdGeomMesh, UsdGeomTetMesh, UsdGeomSubset, UsdGeomPrimvar and
// UsdPreviewSurface.
#include <exemplar/base/atomic_file.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/frame_writer.h>
#include <exemplar/run/frames/single_precision.h>
#include <exemplar/surface/files/material_library.h>
#include <exemplar/surface/shape/vertex_normals.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

namespace Exemplar
{
  namespace
  {
    using SinglePoint = std::array<float, 3>;

    void
    append_number(std::string &text, const float number)
    {
      char buffer[32];
      text.append(buffer, std::to_chars(buffer, buffer + sizeof(buffer), number).ptr);
    }

    void
    append_point(std::string &text, const SinglePoint &point)
    {
      for (unsigned int c = 0; c < 3; ++c)
        append_number(text += c == 0 ? "(" : ", ", point[c]);
      text += ')';
    }

    /// "[a, b, ...]" with each item's text written by `append`.
    template <typename Items, typename Append>
    std::string
    list_of(const Items &items, const Append &append)
    {
      std::string text = "[";
      for (const auto &item : items)
      {
        if (text.size() > 1)
          text += ", ";
        append(text, item);
      }
      return text + ']';
    }

    std::string
    list_of_numbers(const std::vector<unsigned int> &numbers)
    {
      return list_of(numbers, [](std::string &text, const unsigned int number)
                     { fmt::format_to(std::back_inserter(text), "{}", number); });
    }

    /// A valid USD prim name that is not in `taken`; adds it there.
    std::string
    prim_name(const std::string &name, std::set<std::string> &taken)
    {
      std::string result;
      for (const char c : name)
        result += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
      if (result.empty() || std::isdigit(static_cast<unsigned char>(result[0])))
        result = "group_" + result;
      std::string unique = result;
      for (unsigned int i = 2; !taken.insert(unique).second; ++i)
        unique = fmt::format("{}_{}", result, i);
      return unique;
    }

    /// The prim name of the body's surface, or of a carried one.
    std::string
    prim_of(const std::string &carried)
    {
      std::set<std::string> taken = { "surface" };
      return carried.empty() ? "surface" : prim_name(carried, taken);
    }

    /// Texture coordinates of the faces' corners; empty unless all faces have them.
    std::string
    texture_of(const SurfaceMesh &surface)
    {
      const auto &of_faces = surface.face_texture_points;
      if (of_faces.empty()
          || std::any_of(of_faces.begin(), of_faces.end(),
                         [](const auto &points) { return points.empty(); }))
        return "";
      std::vector<unsigned int> indices;
      for (const auto &points : of_faces)
        indices.insert(indices.end(), points.begin(), points.end());
      const std::string points = list_of(surface.texture_points,
                                         [](std::string &text, const std::array<double, 2> &point)
                                         {
                                           append_number(text += '(', single_precision(point[0]));
                                           append_number(text += ", ", single_precision(point[1]));
                                           text += ')';
                                         });
      return "        texCoord2f[] primvars:st = " + points
             + " (\n            interpolation = \"faceVarying\"\n        )\n"
               "        int[] primvars:st:indices = "
             + list_of_numbers(indices) + '\n';
    }

    /// The groups of faces, as GeomSubset prims.
    std::string
    groups_of(const SurfaceMesh &surface)
    {
      std::vector<std::vector<unsigned int>> faces(surface.group_names.size());
      for (unsigned int f = 0; f < surface.face_groups.size(); ++f)
        faces[surface.face_groups[f]].push_back(f);
      std::set<std::string> taken;
      std::string           text;
      for (std::size_t g = 0; g < faces.size(); ++g)
        text += "\n        def GeomSubset \"" + prim_name(surface.group_names[g], taken)
                + "\"\n        {\n            uniform token elementType = \"face\"\n"
                  "            uniform token familyName = \"group\"\n            int[] indices = "
                + list_of_numbers(faces[g]) + "\n        }\n";
      return text;
    }

    /// A tuple of whole numbers for each item.
    template <typename Items>
    std::string
    list_of_tuples(const Items &items)
    {
      return list_of(items, [](std::string &text, const auto &item)
                     { fmt::format_to(std::back_inserter(text), "({})", fmt::join(item, ", ")); });
    }

    /// The attributes that are constant in time, faces and texture coordinates.
    std::string
    topology_of(const SurfaceMesh &surface, const bool with_normals)
    {
      std::vector<unsigned int> counts, corners;
      for (const auto &face : surface.faces)
      {
        counts.push_back(static_cast<unsigned int>(face.size()));
        corners.insert(corners.end(), face.begin(), face.end());
      }
      return "        uniform token subdivisionScheme = \"none\"\n"
             "        int[] faceVertexCounts = "
             + list_of_numbers(counts)
             + "\n        int[] faceVertexIndices = " + list_of_numbers(corners)
             + (with_normals ? "\n        normal3f[] normals (\n            interpolation = "
                               "\"vertex\"\n        )\n"
                             : "\n")
             + texture_of(surface);
    }

    /// The cells of the mesh and its boundary; a guide, so that only the surface is drawn.
    std::string
    topology_of(const Mesh &mesh)
    {
      std::vector<std::array<unsigned int, 3>> faces;
      for (const BoundaryFace &face : mesh.get_boundary_faces())
        faces.push_back(face.nodes);
      return "        uniform token purpose = \"guide\"\n        int4[] tetVertexIndices = "
             + list_of_tuples(mesh.get_cells())
             + "\n        int3[] surfaceFaceVertexIndices = " + list_of_tuples(faces) + '\n';
    }

    std::string
    colour_text(const std::array<double, 3> &colour)
    {
      return fmt::format("({}, {}, {})", colour[0], colour[1], colour[2]);
    }

    /// A material, and the shaders of a texture if it has one.
    std::string
    material_text(const std::string &prim, const SurfaceMaterial &material)
    {
      const std::string path   = "/body/materials/" + prim;
      const bool        image  = material.texture.has_value();
      const std::string colour = image ? ".connect = <" + path + "/image.outputs:rgb>"
                                       : " = " + colour_text(material.colour);
      std::string       text
          = "\n        def Material \"" + prim
            + "\"\n        {\n            token outputs:surface.connect = <" + path
            + "/surface.outputs:surface>\n\n            def Shader \"surface\"\n            {\n"
              "                uniform token info:id = \"UsdPreviewSurface\"\n"
              "                color3f inputs:diffuseColor"
            + colour + "\n                color3f inputs:emissiveColor = "
            + colour_text(material.emission) + "\n                float inputs:opacity = "
            + shortest_text(material.opacity) + "\n                float inputs:roughness = "
            + shortest_text(1. - std::sqrt(material.exponent / 1000.))
            + "\n                token outputs:surface\n            }\n";
      if (image)
        text += "\n            def Shader \"image\"\n            {\n"
                "                uniform token info:id = \"UsdUVTexture\"\n"
                "                asset inputs:file = @@@"
                + material.texture->string()
                + "@@@\n"
                  "                float2 inputs:st.connect = <"
                + path
                + "/st.outputs:result>\n"
                  "                token inputs:wrapS = \"repeat\"\n                token "
                  "inputs:wrapT = \"repeat\"\n"
                  "                float3 outputs:rgb\n            }\n"
                  "\n            def Shader \"st\"\n            {\n"
                  "                uniform token info:id = \"UsdPrimvarReader_float2\"\n"
                  "                string inputs:varname = \"st\"\n                float2 "
                  "outputs:result\n            }\n";
      return text + "        }\n";
    }

    /// The materials of a surface, and the subsets of its faces that have them.
    struct MaterialTexts
    {
      std::string subsets, scope; ///< empty without materials
    };

    MaterialTexts
    materials_of(const SurfaceMesh &surface, const std::filesystem::path &folder)
    {
      const auto known = read_material_libraries(surface, { folder }).materials;
      const auto names = material_names(surface);
      std::map<std::string, std::vector<unsigned int>> faces;
      for (unsigned int face = 0; face < names.size(); ++face)
        if (!names[face].empty())
          faces[names[face]].push_back(face);
      MaterialTexts         texts;
      std::set<std::string> taken;
      for (const auto &[name, list] : faces)
      {
        const std::string prim  = prim_name(name, taken);
        const auto        found = known.find(name);
        texts.subsets += "\n        def GeomSubset \"material_" + prim
                         + "\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n      "
                           "  )\n        {\n"
                           "            uniform token elementType = \"face\"\n"
                           "            uniform token familyName = \"materialBind\"\n            "
                           "int[] indices = "
                         + list_of_numbers(list)
                         + "\n            rel material:binding = </body/materials/" + prim
                         + ">\n        }\n";
        texts.scope
            += material_text(prim, found == known.end() ? SurfaceMaterial() : found->second);
      }
      if (!texts.scope.empty())
        texts.scope = "\n    def Scope \"materials\"\n    {" + texts.scope + "    }\n";
      return texts;
    }

    /// What has a time sample in each frame.
    enum class Sampled
    {
      points,
      extent,
      normals,
      velocities,
      points_of_cells,
      extent_of_cells
    };

    const std::string &
    declaration_of(const Sampled sampled)
    {
      static const std::string declarations[]
          = { "point3f[] points",      "float3[] extent",  "normal3f[] normals",
              "vector3f[] velocities", "point3f[] points", "float3[] extent" };
      return declarations[static_cast<int>(sampled)];
    }

    bool
    is_of_cells(const Sampled sampled)
    {
      return sampled == Sampled::points_of_cells || sampled == Sampled::extent_of_cells;
    }

    const std::string head_of_cells = "    def TetMesh \"cells\"";

    std::string
    begin_samples(const std::string &attribute)
    {
      return "        " + attribute + ".timeSamples = {\n";
    }

    /// The text of a sample in a frame's file.
    std::string
    sample_in(const std::filesystem::path &frame, const Sampled sampled)
    {
      std::ifstream in(frame);
      std::string   line;
      bool          is_inside = !is_of_cells(sampled);
      while (std::getline(in, line))
        if (line == head_of_cells)
          is_inside = !is_inside;
        else if (is_inside && line + '\n' == begin_samples(declaration_of(sampled))
                 && std::getline(in, line))
          if (const auto begin = line.find(": ["); begin != std::string::npos && line.back() == ',')
            return line.substr(begin + 2, line.size() - begin - 3); // without the comma
      throw std::runtime_error(
          frame.string()
          + " is not the frame that this run has written. Remove it, or run the "
            "scene without --resume.");
    }

    std::vector<SinglePoint>
    in_single_precision(const std::vector<SurfaceMesh::Vertex> &vertices)
    {
      std::vector<SinglePoint> points;
      for (const auto &vertex : vertices)
        points.push_back({ { single_precision(vertex[0]), single_precision(vertex[1]),
                             single_precision(vertex[2]) } });
      return points;
    }

    std::array<SinglePoint, 2>
    extent_of(const std::vector<SinglePoint> &points)
    {
      std::array<SinglePoint, 2> extent{ { points.at(0), points.at(0) } };
      for (const SinglePoint &point : points)
        for (unsigned int c = 0; c < 3; ++c)
        {
          extent[0][c] = std::min(extent[0][c], point[c]);
          extent[1][c] = std::max(extent[1][c], point[c]);
        }
      return extent;
    }

    /// Writes the surface of the body as text of Pixar's Universal Scene Description. A frame is a
    /// layer with one time sample; the animation joins the samples.
    class UsdaWriter : public FrameWriter
    {
    public:
      explicit UsdaWriter(const FrameSubject &subject)
          : prim(prim_of(subject.carried)),
            topology(topology_of(*subject.surface, subject.playback.with_normals)),
            groups(groups_of(*subject.surface)),
            materials(materials_of(*subject.surface, subject.folder)),
            cells(subject.carried.empty() && !subject.mesh.is_shell() && subject.playback.with_cells
                      ? topology_of(subject.mesh)
                      : ""),
            faces(subject.surface->faces), n_nodes(subject.mesh.n_nodes()),
            meters_per_unit(subject.mesh.get_scale()), playback(subject.playback),
            has_velocities(playback.has_velocities && subject.carried != name_of_obstacles)
      {
      }

      void
      write(const Frame &frame, const std::filesystem::path &file) const override
      {
        AtomicFile atomic_file(file);
        write_layer(atomic_file.stream(), "a frame", { frame.time },
                    [&](std::size_t, const Sampled sampled) { return sample_of(frame, sampled); });
        atomic_file.commit_without_sync();
      }

      void
      write_animation(const std::vector<WrittenFrame> &frames,
                      const std::filesystem::path     &file) const override
      {
        std::vector<double> times;
        for (const WrittenFrame &frame : frames)
          times.push_back(frame.time);
        AtomicFile atomic_file(file);
        write_layer(atomic_file.stream(), "an animation", times,
                    [&](const std::size_t i, const Sampled sampled)
                    { return sample_in(frames[i].file, sampled); });
        if (!frames.front().obstacles.empty())
          atomic_file.stream() << "\ndef Xform \"obstacles\" (\n    references = @./"
                               << file.stem().string() << '_' << name_of_obstacles
                               << ".usda@\n)\n{\n}\n";
        atomic_file.commit();
      }

    private:
      /// time / interval, which is the frame's number if frames are evenly spaced in time.
      std::string
      time_code(const double time) const
      {
        const double code    = time / playback.interval;
        const double nearest = std::round(code);
        return shortest_text(std::abs(code - nearest) < 1e-6 ? nearest : code);
      }

      std::string
      sample_of(const Frame &frame, const Sampled sampled) const
      {
        const auto points = [&]
        {
          if (!is_of_cells(sampled))
            return frame.surface;
          std::vector<SurfaceMesh::Vertex> nodes(n_nodes);
          for (unsigned int dof = 0; dof < 3 * n_nodes; ++dof)
            nodes[dof / 3][dof % 3] = frame.positions[dof] / meters_per_unit;
          return nodes;
        };
        const auto list = [](const std::vector<SurfaceMesh::Vertex> &vertices)
        { return list_of(in_single_precision(vertices), append_point); };
        if (sampled == Sampled::extent || sampled == Sampled::extent_of_cells)
          return list_of(extent_of(in_single_precision(points())), append_point);
        if (sampled == Sampled::normals)
          return list(vertex_normals(faces, frame.surface));
        return list(sampled == Sampled::velocities ? frame.surface_velocities : points());
      }

      template <typename SampleOf>
      void
      write_samples(std::ostream               &out,
                    const std::vector<Sampled> &all,
                    const std::vector<double>  &times,
                    const SampleOf             &of) const
      {
        for (const Sampled sampled : all)
        {
          out << begin_samples(declaration_of(sampled));
          for (std::size_t i = 0; i < times.size(); ++i)
            out << "            " << time_code(times[i]) << ": " << of(i, sampled) << ",\n";
          out << "        }\n";
        }
      }

      template <typename SampleOf>
      void
      write_layer(std::ostream              &out,
                  const std::string         &what,
                  const std::vector<double> &times,
                  const SampleOf            &sample_of) const
      {
        out << "#usda 1.0\n(\n    doc = \"" << what
            << " by exemplar\"\n    defaultPrim = \"body\"\n    metersPerUnit = "
            << shortest_text(meters_per_unit) << "\n    upAxis = \""
            << (playback.z_is_up ? 'Z' : 'Y')
            << "\"\n    timeCodesPerSecond = " << shortest_text(playback.frames_per_second)
            << "\n    framesPerSecond = " << shortest_text(playback.frames_per_second)
            << "\n    startTimeCode = " << time_code(times.front())
            << "\n    endTimeCode = " << time_code(times.back())
            << "\n)\n\ndef Xform \"body\" (\n    kind = \"component\"\n)\n{\n"
               "    def Mesh \""
            << prim << "\"\n    {\n"
            << topology;
        std::vector<Sampled> of_surface{ Sampled::points, Sampled::extent };
        if (playback.with_normals)
          of_surface.push_back(Sampled::normals);
        if (has_velocities)
          of_surface.push_back(Sampled::velocities);
        write_samples(out, of_surface, times, sample_of);
        out << groups << materials.subsets << "    }\n";
        if (!cells.empty())
        {
          out << '\n' << head_of_cells << "\n    {\n" << cells;
          write_samples(out, { Sampled::points_of_cells, Sampled::extent_of_cells }, times,
                        sample_of);
          out << "    }\n";
        }
        out << materials.scope << "}\n";
      }

      const std::string   prim;
      const std::string   topology, groups; ///< the same in all frames
      const MaterialTexts materials;
      const std::string   cells; ///< faces and cells of the mesh; empty for what is carried
      const std::vector<std::vector<unsigned int>> faces;
      const unsigned int                           n_nodes;
      const double                                 meters_per_unit;
      const Playback                               playback;
      const bool has_velocities; ///< not of obstacles, which may jump
    };
  } // namespace

  std::unique_ptr<const FrameWriter>
  make_usda_writer(const FrameSubject &subject)
  {
    return std::make_unique<const UsdaWriter>(subject);
  }
} // namespace Exemplar
