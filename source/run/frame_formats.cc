// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/frame_formats.h>
#include <exemplar/run/frame_writer.h>

#include <regex>
#include <string>

namespace Exemplar
{
  // A new format is a file with its writer, a declaration here and a line in the table.
  std::unique_ptr<const FrameWriter>
  make_vtu_writer(const FrameSubject &subject);
  std::unique_ptr<const FrameWriter>
  make_obj_writer(const FrameSubject &subject);
  std::unique_ptr<const FrameWriter>
  make_ply_writer(const FrameSubject &subject);
  std::unique_ptr<const FrameWriter>
  make_mdd_writer(const FrameSubject &subject);
  std::unique_ptr<const FrameWriter>
  make_pc2_writer(const FrameSubject &subject);
  std::unique_ptr<const FrameWriter>
  make_usda_writer(const FrameSubject &subject);

  const std::vector<FrameFormat> &
  frame_formats()
  {
    using std::string_literals::          operator""s; // for bytes that are 0
    static const std::vector<FrameFormat> formats = {
      { "vtu", "animation.pvd", make_vtu_writer,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"",
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">" },
      { "obj", "", make_obj_writer, "# a frame by exemplar\n", "", true },
      { "ply", "", make_ply_writer,
        "ply\nformat binary_little_endian 1.0\ncomment a frame by exemplar\n", "", true },
      // one frame; an animation has fewer than 2^24
      { "mdd", "animation.mdd", make_mdd_writer, "\0\0\0\1"s, "\0"s, true },
      { "pc2", "animation.pc2", make_pc2_writer, "POINTCACHE2\0\1\0\0\0"s, "POINTCACHE2\0\1\0\0\0"s,
        true },
      { "usda", "animation.usda", make_usda_writer, "#usda 1.0\n(\n    doc = \"a frame by exemplar",
        "#usda 1.0\n(\n    doc = \"an animation by exemplar", true },
    };
    return formats;
  }

  std::vector<std::string>
  names_of(const std::vector<FrameFormat> &formats)
  {
    std::vector<std::string> names;
    for (const FrameFormat &format : formats)
      names.push_back(format.name);
    return names;
  }

  std::string
  FrameFormat::frame_name(const unsigned int step) const
  {
    const std::string digits = std::to_string(step);
    return "frame_" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits + "."
           + name;
  }

  std::optional<unsigned int>
  FrameFormat::step_of(const std::string &file) const
  {
    static const std::regex pattern("frame_([0-9]{4}|[1-9][0-9]{4,8})\\.(.+)");
    std::smatch             parts;
    if (std::regex_match(file, parts, pattern) && parts[2] == name)
      return static_cast<unsigned int>(std::stoul(parts[1]));
    return std::nullopt;
  }

  std::optional<std::string>
  FrameFormat::beginning_of(const std::string &file) const
  {
    if (!animation.empty() && file == animation)
      return animation_beginning;
    return step_of(file) ? std::make_optional(frame_beginning) : std::nullopt;
  }
} // namespace Exemplar
