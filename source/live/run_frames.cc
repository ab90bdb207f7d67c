// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/exemplar.h>
#include <exemplar/live/run_frames.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <zlib.h>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr std::size_t max_bytes = std::size_t(1)
                                      << 32; ///< of an array: more is no frame of ours

    std::string
    text_of_file(const fs::path &file)
    {
      std::ifstream      in(file, std::ios::binary);
      std::ostringstream text;
      if (!in || !(text << in.rdbuf()))
        throw UserError(file.string() + " cannot be read.");
      return text.str();
    }

    [[noreturn]] void
    refuse(const fs::path &file)
    {
      throw UserError(
          file.string()
          + " is no frame that exemplar has written. Run the scene again, with vtu among "
            "Output/Formats.");
    }

    /// An array of a frame: in base64 its sizes, and then its bytes, compressed by zlib.
    template <typename Number>
    std::vector<Number>
    array_in(const fs::path &file, const std::string &text, const std::string &name)
    {
      const auto            where = text.find(" Name=\"" + name + "\"");
      const auto            begin = where == std::string::npos ? where : text.find('>', where);
      const auto            end   = begin == std::string::npos ? begin : text.find('<', begin);
      constexpr std::size_t sizes_in_text = 44; // 32 bytes
      if (end == std::string::npos || end - begin - 1 < sizes_in_text)
        refuse(file);
      const auto sizes = dealii::Utilities::decode_base64(text.substr(begin + 1, sizes_in_text));
      const auto compressed = dealii::Utilities::decode_base64(
          text.substr(begin + 1 + sizes_in_text, end - begin - 1 - sizes_in_text));
      std::uint64_t n_bytes = 0;
      std::memcpy(&n_bytes, sizes.data() + sizeof(n_bytes), sizeof(n_bytes));
      if (n_bytes > max_bytes || n_bytes % sizeof(Number) != 0)
        refuse(file);
      std::vector<Number> numbers(n_bytes / sizeof(Number));
      uLongf              size = n_bytes;
      if (uncompress(reinterpret_cast<Bytef *>(numbers.data()), &size, compressed.data(),
                     compressed.size())
              != Z_OK
          || size != n_bytes)
        refuse(file);
      return numbers;
    }

    using Face = std::array<unsigned int, 3>;

    Face
    sorted(Face face)
    {
      std::sort(face.begin(), face.end());
      return face;
    }
  } // namespace

  std::vector<RunFrame>
  frames_of_run(const fs::path &directory)
  {
    const fs::path animation = directory / "animation.pvd";
    if (!fs::exists(animation))
      throw UserError(directory.string()
                      + " has no animation.pvd. Give the output directory of a run that has ended, "
                        "with vtu among "
                        "Output/Formats.");
    const std::string       text = text_of_file(animation);
    static const std::regex entry("timestep=\"([^\"]*)\" file=\"([^\"/]*\\.vtu)\"");
    std::vector<RunFrame>   frames;
    for (auto found = std::sregex_iterator(text.begin(), text.end(), entry);
         found != std::sregex_iterator(); ++found)
      frames.push_back(
          { std::strtod((*found)[1].str().c_str(), nullptr), directory / (*found)[2].str() });
    if (frames.empty())
      refuse(animation);
    return frames;
  }

  std::vector<double>
  places_in(const fs::path &file)
  {
    return array_in<double>(file, text_of_file(file), "Points");
  }

  std::vector<std::array<unsigned int, 3>>
  boundary_in(const fs::path &file)
  {
    const std::string    text         = text_of_file(file);
    const auto           connectivity = array_in<std::int32_t>(file, text, "connectivity");
    const auto           offsets      = array_in<std::int32_t>(file, text, "offsets");
    std::map<Face, Face> open; // sorted nodes -> outwards
    std::size_t          begin = 0;
    for (const std::int32_t end : offsets)
    {
      if (end < std::int32_t(begin) + 4 || std::size_t(end) > connectivity.size())
        refuse(file);
      const auto node = [&](const std::size_t i) { return unsigned(connectivity[begin + i]); };
      // of a tetrahedron that is positively oriented
      for (const Face &face :
           { Face{ { node(0), node(2), node(1) } }, Face{ { node(0), node(1), node(3) } },
             Face{ { node(1), node(2), node(3) } }, Face{ { node(0), node(3), node(2) } } })
        if (const auto met = open.find(sorted(face)); met != open.end())
          open.erase(met);
        else
          open[sorted(face)] = face;
      begin = end;
    }
    std::vector<Face> boundary;
    for (const auto &entry : open)
      boundary.push_back(entry.second);
    return boundary;
  }
} // namespace Exemplar::Live
