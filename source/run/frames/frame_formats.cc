// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/frame_writer.h>

#include <fmt/core.h>

#include <regex>
#include <string>

namespace Exemplar
{
  // To add a format: a file with its writer, a declaration here and a line in the table.
  std::unique_ptr<const FrameWriter>
  make_vtu_writer(const FrameSubject &subject);
  std::unique_ptr<const FrameWriter>
  make_carried_vtu_writer(const FrameSubject &subject);
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

  namespace
  {
    /// Suffix of file names for a carried surface.
    std::string
    with_line(const std::string &carried)
    {
      return carried.empty() ? "" : "_" + carried;
    }
  } // namespace

  const std::vector<FrameFormat> &
  frame_formats()
  {
    using std::string_literals::          operator""s; // for bytes that are 0
    static const std::vector<FrameFormat> formats = {
      { "vtu", "animation.pvd", make_vtu_writer,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"",
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">", false, false,
        write_joint_vtu, "pvtu",
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\"",
        make_carried_vtu_writer },
      { "obj", "", make_obj_writer, "# a frame by exemplar\n", "", true },
      { "ply", "", make_ply_writer,
        "ply\nformat binary_little_endian 1.0\ncomment a frame by exemplar\n", "", true },
      // frames have a count of 1; animations fewer than 2^24
      { "mdd", "animation.mdd", make_mdd_writer, "\0\0\0\1"s, "\0"s, true },
      { "pc2", "animation.pc2", make_pc2_writer, "POINTCACHE2\0\1\0\0\0"s, "POINTCACHE2\0\1\0\0\0"s,
        true },
      { "usda", "animation.usda", make_usda_writer, "#usda 1.0\n(\n    doc = \"a frame by exemplar",
        "#usda 1.0\n(\n    doc = \"an animation by exemplar", true, true },
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

  std::unique_ptr<const FrameWriter>
  FrameFormat::writer_of(const FrameSubject &subject) const
  {
    const bool is_of_body = subject.carried.empty() || make_carried_writer == nullptr;
    return (is_of_body ? make_writer : make_carried_writer)(subject);
  }

  std::string
  FrameFormat::frame_name(const unsigned int step, const std::string &carried) const
  {
    return fmt::format("frame_{:04}{}.{}", step, with_line(carried), name);
  }

  std::string
  FrameFormat::animation_name(const std::string &carried) const
  {
    const std::filesystem::path file = animation;
    return file.stem().string() + with_line(carried) + file.extension().string();
  }

  std::vector<std::string>
  FrameFormat::names_of_pieces(const unsigned int step,
                               const unsigned int n_processes,
                               const std::string &carried) const
  {
    if (n_processes == 1 || !carried.empty())
      return { frame_name(step, carried) };
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
    static const std::regex frame("frame_" + number + "(_.+)?\\.([^.]+)"); // or a piece of one
    std::smatch             parts;
    if (std::regex_match(file, parts, frame)
        && (parts[3] == name || (has_pieces() && parts[3] == joint_ending && !parts[2].matched)))
      return static_cast<unsigned int>(std::stoul(parts[1]));
    return std::nullopt;
  }

  bool
  FrameFormat::is_animation(const std::string &file) const
  {
    const std::filesystem::path own = animation, other = file;
    const std::string           stem = own.stem().string() + "_";
    return !animation.empty()
           && (file == animation
               || (other.extension() == own.extension()
                   && other.stem().string().compare(0, stem.size(), stem) == 0));
  }

  std::optional<std::string>
  FrameFormat::beginning_of(const std::string &file) const
  {
    if (is_animation(file))
      return animation_beginning;
    if (const auto step = step_of(file); !step)
      return std::nullopt;
    else if (has_pieces() && file == joint_name(*step))
      return joint_beginning;
    return frame_beginning;
  }
} // namespace Exemplar
