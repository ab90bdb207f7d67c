// SPDX-License-Identifier: GPL-3.0-or-later
// Format: G. Turk, "The PLY polygon file format", 1994.
#include <exemplar/base/atomic_file.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/frame_writer.h>
#include <exemplar/run/frames/raw_bytes.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Numbers for groups of faces: their names if all are numbers, else 1, 2, ...
    std::vector<std::int32_t>
    group_numbers(const SurfaceMesh &surface)
    {
      const bool are_numbers
          = std::all_of(surface.group_names.begin(), surface.group_names.end(),
                        [](const std::string &name)
                        {
                          return !name.empty() && name.size() < 10
                                 && name.find_first_not_of("0123456789") == std::string::npos;
                        });
      std::vector<std::int32_t> numbers;
      for (const std::string &name : surface.group_names)
        numbers.push_back(are_numbers ? std::stoi(name)
                                      : static_cast<std::int32_t>(numbers.size() + 1));
      return numbers;
    }

    /// Whether all faces have fewer than 256 corners: counts are then bytes, as some readers
    /// require.
    bool
    counts_are_bytes(const SurfaceMesh &surface)
    {
      return std::all_of(surface.faces.begin(), surface.faces.end(),
                         [](const auto &face) { return face.size() < 256; });
    }

    std::string
    head_of_ply(const SurfaceMesh &surface)
    {
      const std::string count = counts_are_bytes(surface) ? "uchar" : "int";
      return fmt::format(
          "ply\nformat binary_little_endian 1.0\ncomment a frame by exemplar\nelement vertex "
          "{}\nproperty double x\nproperty double y\nproperty double z\nelement face {}\nproperty "
          "list {} int vertex_indices\n{}end_header\n",
          surface.vertices.size(), surface.faces.size(), count,
          surface.face_groups.empty() ? "" : "property int label\n");
    }

    std::string
    faces_of_ply(const SurfaceMesh &surface)
    {
      constexpr auto little  = ByteOrder::little;
      const bool     bytes   = counts_are_bytes(surface);
      const auto     numbers = group_numbers(surface);
      std::string    text;
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
      {
        const auto &face = surface.faces[f];
        if (bytes)
          append_raw<little>(text, static_cast<std::uint8_t>(face.size()));
        else
          append_raw<little>(text, static_cast<std::int32_t>(face.size()));
        for (const unsigned int vertex : face)
          append_raw<little>(text, static_cast<std::int32_t>(vertex));
        if (!surface.face_groups.empty())
          append_raw<little>(text, numbers[surface.face_groups[f]]);
      }
      return text;
    }

    /// Writes the surface of the body as .ply, binary, with coordinates in double precision.
    class PlyWriter : public FrameWriter
    {
    public:
      explicit PlyWriter(const SurfaceMesh &surface)
          : head(head_of_ply(surface)), faces(faces_of_ply(surface))
      {
      }

      void
      write(const Frame &frame, const std::filesystem::path &file) const override
      {
        std::string vertices;
        vertices.reserve(24 * frame.surface.size());
        for (const auto &vertex : frame.surface)
          for (const double coordinate : vertex)
            append_raw<ByteOrder::little>(vertices, coordinate);
        AtomicFile atomic_file(file);
        atomic_file.stream() << head << vertices << faces;
        atomic_file.commit_without_sync();
      }

      void
      write_animation(const std::vector<WrittenFrame> &,
                      const std::filesystem::path &) const override
      {
      }

    private:
      const std::string head, faces; ///< the same in all frames
    };
  } // namespace

  std::unique_ptr<const FrameWriter>
  make_ply_writer(const FrameSubject &subject)
  {
    return std::make_unique<const PlyWriter>(*subject.surface);
  }
} // namespace Exemplar
