// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/frame_writer.h>

#include <fmt/core.h>

#include <regex>
#include <string>

namespace Exemplar
{
  // A new format is a file with its writer, a declaration here and a line in the table.
  std::unique_ptr<const FrameWriter>
  make_vtu_writer(const FrameSubject &subject);
  void
  write_joint_vtu(const Frame                    &frame,
                  const std::vector<std::string> &pieces,
                  const std::filesystem::path    &file);
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
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">", false,
        write_joint_vtu, "pvtu",
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\"" },
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
    return fmt::format("frame_{:04}.{}", step, name);
  }

  std::vector<std::string>
  FrameFormat::names_of_pieces(const unsigned int step, const unsigned int n_processes) const
  {
    if (n_processes == 1)
      return { frame_name(step) };
    std::vector<std::string> names;
    for (unsigned int process = 0; process < n_processes; ++process)
      names.push_back(fmt::format("frame_{:04}_process_{:04}.{}", step, process, name));
    return names;
  }

  std::string
  FrameFormat::joint_name(const unsigned int step) const
  {
    return fmt::format("frame_{:04}.{}", step, joint_ending);
  }

  std::optional<unsigned int>
  FrameFormat::step_of(const std::string &file) const
  {
    const std::string       number = "([0-9]{4}|[1-9][0-9]{4,8})";
    static const std::regex frame("frame_" + number + "\\.(.+)"),
        piece("frame_" + number + "_process_" + number + "\\.(.+)");
    std::smatch parts;
    const bool  is_whole = std::regex_match(file, parts, frame)
                          && (parts[2] == name || (has_pieces() && parts[2] == joint_ending));
    if (is_whole || (has_pieces() && std::regex_match(file, parts, piece) && parts[3] == name))
      return static_cast<unsigned int>(std::stoul(parts[1]));
    return std::nullopt;
  }

  std::optional<std::string>
  FrameFormat::beginning_of(const std::string &file) const
  {
    if (!animation.empty() && file == animation)
      return animation_beginning;
    if (const auto step = step_of(file); !step)
      return std::nullopt;
    else if (has_pieces() && file == joint_name(*step))
      return joint_beginning;
    return frame_beginning;
  }
} // namespace Exemplar
