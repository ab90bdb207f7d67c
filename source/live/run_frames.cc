// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/exemplar.h>
#include <exemplar/live/run_frames.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <zlib.h>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr std::size_t max_bytes = std::size_t(1) << 32; ///< limit of an array's size

    [[noreturn]] void
    refuse(const fs::path &file, const std::string &why)
    {
      throw UserError(file.string() + " is no frame that exemplar has written: " + why
                      + ". Run the scene again, with vtu among Output/Formats.");
    }

    std::string
    text_of_file(const fs::path &file)
    {
      std::error_code none;
      if (fs::exists(file, none) && !fs::is_regular_file(file, none)) // reading a pipe would block
        throw UserError(file.string() + " is no regular file. Give the output directory of a run.");
      std::string reason;
      if (auto text = read_text_file(file, &reason))
        return std::move(*text);
      throw UserError(file.string() + " cannot be read: " + reason + ".");
    }

    /// The value of an attribute in the text of a tag; nothing if it has none.
    std::optional<std::string>
    attribute(const std::string &tag, const std::string &name)
    {
      const std::string before = " " + name + "=\"";
      const auto        begin  = tag.find(before);
      const auto end = begin == std::string::npos ? begin : tag.find('"', begin + before.size());
      if (end == std::string::npos)
        return std::nullopt;
      return tag.substr(begin + before.size(), end - begin - before.size());
    }

    std::vector<unsigned char>
    decoded(const fs::path &file, const std::string &name, const std::string &base64)
    {
      try
      {
        return dealii::Utilities::decode_base64(base64);
      }
      catch (const std::exception &)
      {
        refuse(file, "its array " + name + " is damaged");
      }
    }

    /// An array of a frame, in base64: its sizes, then its bytes, compressed by zlib.
    template <typename Number>
    std::vector<Number>
    array_in(const fs::path &file, const std::string &text, const std::string &name)
    {
      const auto            where = text.find(" Name=\"" + name + "\"");
      const auto            begin = where == std::string::npos ? where : text.find('>', where);
      const auto            end   = begin == std::string::npos ? begin : text.find('<', begin);
      constexpr std::size_t sizes_in_text = 44; // base64 of 32 bytes
      if (end == std::string::npos || end - begin - 1 < sizes_in_text)
        refuse(file, "it has no array " + name);
      const auto sizes      = decoded(file, name, text.substr(begin + 1, sizes_in_text));
      const auto compressed = decoded(
          file, name, text.substr(begin + 1 + sizes_in_text, end - begin - 1 - sizes_in_text));
      std::uint64_t n_bytes = 0;
      if (sizes.size() < 2 * sizeof(n_bytes))
        refuse(file, "its array " + name + " is damaged");
      std::memcpy(&n_bytes, sizes.data() + sizeof(n_bytes), sizeof(n_bytes));
      // zlib expands by a factor of about 1000 at most, so that a damaged size cannot exhaust
      // memory
      if (n_bytes > max_bytes || n_bytes > 1100 * compressed.size()
          || n_bytes % sizeof(Number) != 0)
        refuse(file, "its array " + name + " has another size than it says");
      std::vector<Number> numbers(n_bytes / sizeof(Number));
      uLongf              size = n_bytes;
      if (uncompress(reinterpret_cast<Bytef *>(numbers.data()), &size, compressed.data(),
                     compressed.size())
              != Z_OK
          || size != n_bytes)
        refuse(file, "its array " + name + " is damaged");
      return numbers;
    }

    using Face = std::array<unsigned int, 3>;
    using Cell = std::array<unsigned int, 4>;

    /// The corners of a cell, which are different points of the frame.
    Cell
    cell_at(const fs::path                  &file,
            const std::vector<std::int32_t> &connectivity,
            const std::size_t                begin,
            const std::size_t                n_points)
    {
      Cell cell{};
      for (unsigned int i = 0; i < 4; ++i)
      {
        const std::int32_t node = connectivity[begin + i];
        if (node < 0 || std::size_t(node) >= n_points)
          refuse(file, "a cell has a node that is not there");
        cell[i] = static_cast<unsigned int>(node);
      }
      if (std::set<unsigned int>(cell.begin(), cell.end()).size() < 4)
        refuse(file, "a cell has a node twice");
      return cell;
    }

    void
    require_places(const fs::path &file, const std::vector<double> &places)
    {
      if (places.empty() || places.size() % 3 != 0)
        refuse(file, "it has no points");
      for (const double place : places)
        if (!(std::abs(place) < 1e30)) // limit of what can be drawn
          refuse(file, "a point has no finite place");
    }

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
    if (std::error_code none; !fs::exists(animation, none))
      throw UserError(directory.string()
                      + (fs::is_directory(directory, none)
                             ? " has no animation.pvd. Give the output directory of a run that has "
                               "ended, with vtu "
                               "among Output/Formats and Output/Every not 0."
                             : " is no directory. Give the output directory of a run: exemplar "
                               "SCENE.prm --output "
                               "DIRECTORY makes one."));
    const std::string     text = text_of_file(animation);
    std::vector<RunFrame> frames;
    const std::string     tag = "<DataSet";
    for (auto begin = text.find(tag); begin != std::string::npos; begin = text.find(tag, begin + 1))
    {
      const std::string entry = text.substr(begin, text.find('>', begin) - begin);
      const auto        time = attribute(entry, "timestep"), name = attribute(entry, "file");
      if (!time || !name || !std::isfinite(parse_number(*time))
          || name->find('/') != std::string::npos || fs::path(*name).extension() != ".vtu")
        throw UserError(animation.string()
                        + " is no list of frames that exemplar has written. Run the scene again.");
      if (attribute(entry, "part").value_or("0") == "0")
        frames.push_back({ parse_number(*time), directory / *name });
      else if (!frames.empty())
        frames.back().obstacles = directory / *name;
    }
    if (frames.empty())
      throw UserError(animation.string() + " lists no frames. Run the scene again.");
    return frames;
  }

  namespace
  {
    std::vector<double>
    places_in_text(const fs::path &file, const std::string &text)
    {
      std::vector<double> places = array_in<double>(file, text, "Points");
      require_places(file, places);
      return places;
    }
  } // namespace

  std::vector<double>
  places_in(const fs::path &file)
  {
    return places_in_text(file, text_of_file(file));
  }

  std::vector<double>
  rest_places_in(const fs::path &file)
  {
    const std::string         text   = text_of_file(file);
    std::vector<double>       places = places_in_text(file, text);
    const std::vector<double> moved  = array_in<double>(file, text, "displacement");
    if (moved.size() != places.size())
      refuse(file, "its points have other displacements");
    for (std::size_t i = 0; i < places.size(); ++i)
      places[i] -= moved[i];
    require_places(file, places);
    return places;
  }

  std::vector<std::vector<unsigned int>>
  polygons_in(const fs::path &file)
  {
    const std::string text         = text_of_file(file);
    const auto        connectivity = array_in<std::int32_t>(file, text, "connectivity");
    const std::size_t n_points     = places_in_text(file, text).size() / 3;
    std::vector<std::vector<unsigned int>> polygons;
    std::size_t                            begin = 0;
    for (const std::int32_t end : array_in<std::int32_t>(file, text, "offsets"))
    {
      if (end < 0 || std::size_t(end) < begin + 3 || std::size_t(end) > connectivity.size())
        refuse(file, "a polygon has fewer than three corners");
      polygons.emplace_back(connectivity.begin() + begin, connectivity.begin() + end);
      for (const unsigned int corner : polygons.back())
        if (corner >= n_points)
          refuse(file, "a polygon has a corner that is not there");
      begin = end;
    }
    return polygons;
  }

  std::vector<std::array<unsigned int, 3>>
  boundary_in(const fs::path &file)
  {
    const std::string text         = text_of_file(file);
    const auto        connectivity = array_in<std::int32_t>(file, text, "connectivity");
    const auto        offsets      = array_in<std::int32_t>(file, text, "offsets");
    const std::size_t n_points     = array_in<double>(file, text, "Points").size() / 3;
    if (!offsets.empty() && offsets.front() == 3) // the triangles of a shell
    {
      std::vector<Face> triangles;
      for (const auto &polygon : polygons_in(file))
        triangles.push_back({ { polygon[0], polygon[1], polygon[2] } });
      return triangles;
    }
    std::map<Face, Face> open; // sorted nodes -> outwards
    std::size_t          begin = 0;
    for (const std::int32_t end : offsets)
    {
      if (end < 0 || std::size_t(end) < begin + 4 || std::size_t(end) > connectivity.size())
        refuse(file, "a cell has fewer than four nodes");
      const Cell cell = cell_at(file, connectivity, begin, n_points);
      // faces of a positively oriented tetrahedron
      for (const Face &face :
           { Face{ { cell[0], cell[2], cell[1] } }, Face{ { cell[0], cell[1], cell[3] } },
             Face{ { cell[1], cell[2], cell[3] } }, Face{ { cell[0], cell[3], cell[2] } } })
        if (const auto met = open.find(sorted(face)); met != open.end())
          open.erase(met);
        else
          open[sorted(face)] = face;
      begin = end;
    }
    if (open.empty())
      refuse(file, "it has no cells");
    std::vector<Face> boundary;
    for (const auto &entry : open)
      boundary.push_back(entry.second);
    return boundary;
  }
} // namespace Exemplar::Live
