// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/frame_formats.h>
#include <exemplar/run/frame_writer.h>

#include <regex>

namespace Exemplar
{
  // A new format is a file with its writer, a declaration here and a line in the table.
  std::unique_ptr<const FrameWriter>
  make_vtu_writer(const Mesh &mesh);

  const std::vector<FrameFormat> &
  frame_formats()
  {
    static const std::vector<FrameFormat> formats = { { "vtu", "animation.pvd", make_vtu_writer } };
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

  bool
  FrameFormat::owns(const std::string &file) const
  {
    static const std::regex pattern("frame_[0-9]+\\.(.+)");
    std::smatch             parts;
    return (!animation.empty() && file == animation)
           || (std::regex_match(file, parts, pattern) && parts[1] == name);
  }
} // namespace Exemplar
