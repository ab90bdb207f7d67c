// SPDX-License-Identifier: GPL-3.0-or-later
// Format: OpenUSD, "USDA file format" and schemas UsdGeomMesh, UsdGeomSubset and UsdGeomPrimvar.
#include <exemplar/base/atomic_file.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/frame_writer.h>
#include <exemplar/run/frames/single_precision.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
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

    /// The attributes that are constant in time, faces and texture coordinates.
    std::string
    topology_of(const SurfaceMesh &surface)
    {
      std::vector<unsigned int> counts, corners;
      for (const auto &face : surface.faces)
      {
        counts.push_back(static_cast<unsigned int>(face.size()));
        corners.insert(corners.end(), face.begin(), face.end());
      }
      return "        uniform token subdivisionScheme = \"none\"\n"
             "        int[] faceVertexCounts = "
             + list_of_numbers(counts) + "\n        int[] faceVertexIndices = "
             + list_of_numbers(corners) + '\n' + texture_of(surface);
    }

    /// The attribute with a time sample in each frame.
    const std::string &
    points_attribute()
    {
      static const std::string name = "point3f[] points";
      return name;
    }

    const std::string &
    extent_attribute()
    {
      static const std::string name = "float3[] extent";
      return name;
    }

    std::string
    begin_samples(const std::string &attribute)
    {
      return "        " + attribute + ".timeSamples = {\n";
    }

    /// The text of an attribute's sample in a frame's file.
    std::string
    sample_in(const std::filesystem::path &frame, const std::string &attribute)
    {
      std::ifstream in(frame);
      std::string   line;
      while (std::getline(in, line))
        if (line + '\n' == begin_samples(attribute) && std::getline(in, line))
          if (const auto begin = line.find(": ["); begin != std::string::npos && line.back() == ',')
            return line.substr(begin + 2, line.size() - begin - 3); // without the comma
      throw std::runtime_error(
          frame.string()
          + " is not the frame that this run has written. Remove it, or run the "
            "scene without --resume.");
    }

    struct Samples
    {
      std::string points, extent;
    };

    Samples
    samples_of(const Frame &frame)
    {
      std::vector<SinglePoint> points;
      for (const auto &vertex : frame.surface)
        points.push_back({ { single_precision(vertex[0]), single_precision(vertex[1]),
                             single_precision(vertex[2]) } });
      std::array<SinglePoint, 2> extent{ { points.at(0), points.at(0) } };
      for (const SinglePoint &point : points)
        for (unsigned int c = 0; c < 3; ++c)
        {
          extent[0][c] = std::min(extent[0][c], point[c]);
          extent[1][c] = std::max(extent[1][c], point[c]);
        }
      return { list_of(points, append_point), list_of(extent, append_point) };
    }

    /// Writes the surface of the body as text of Pixar's Universal Scene Description. A frame is a
    /// layer with one time sample; the animation joins the samples.
    class UsdaWriter : public FrameWriter
    {
    public:
      explicit UsdaWriter(const FrameSubject &subject)
          : prim(prim_of(subject.carried)), topology(topology_of(*subject.surface)),
            groups(groups_of(*subject.surface)), meters_per_unit(subject.mesh.get_scale()),
            playback(subject.playback)
      {
      }

      void
      write(const Frame &frame, const std::filesystem::path &file) const override
      {
        const Samples samples = samples_of(frame);
        AtomicFile    atomic_file(file);
        write_layer(atomic_file.stream(), "a frame", { frame.time },
                    [&](std::size_t, const std::string &attribute)
                    { return attribute == points_attribute() ? samples.points : samples.extent; });
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
                    [&](const std::size_t i, const std::string &attribute)
                    { return sample_in(frames[i].file, attribute); });
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
        for (const std::string &attribute : { points_attribute(), extent_attribute() })
        {
          out << begin_samples(attribute);
          for (std::size_t i = 0; i < times.size(); ++i)
            out << "            " << time_code(times[i]) << ": " << sample_of(i, attribute)
                << ",\n";
          out << "        }\n";
        }
        out << groups << "    }\n}\n";
      }

      const std::string prim;
      const std::string topology, groups; ///< the same in all frames
      const double      meters_per_unit;
      const Playback    playback;
    };
  } // namespace

  std::unique_ptr<const FrameWriter>
  make_usda_writer(const FrameSubject &subject)
  {
    return std::make_unique<const UsdaWriter>(subject);
  }
} // namespace Exemplar
