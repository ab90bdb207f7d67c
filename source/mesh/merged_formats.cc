// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/merged_formats.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

namespace Exemplar
{
  namespace
  {
    /// First bytes of the formats, without white space before them: with any, gmsh would take a
    /// .msh or .pos for a script.
    constexpr std::array<std::pair<const char *, const char *>, 10> beginnings{
      { { "ISO-10303-21;", ".step" },
        { "DBRep_DrawableShape", ".brep" },
        { "CASCADE Topology V", ".brep" },
        { "$MeshFormat", ".msh" },
        { "MeshVersionFormatted", ".mesh" },
        { "ply\n", ".ply" },
        { "ply\r", ".ply" },
        { "# vtk DataFile", ".vtk" },
        { "#VRML", ".wrl" },
        { "$PostFormat", ".pos" } }
    };

    bool
    begins_with(const std::string &bytes, const std::size_t at, const std::string &text)
    {
      return bytes.compare(at, text.size(), text) == 0;
    }

    /// Whether bytes are an STL: "solid" and soon a facet, or as many triangles as the header says.
    bool
    is_stl(const std::string &bytes)
    {
      constexpr std::size_t head = 84, triangle = 50;
      if (begins_with(bytes, 0, "solid") && bytes.substr(0, 1000).find("facet") != std::string::npos)
        return true;
      if (bytes.size() < head)
        return false;
      std::uint32_t n_triangles;
      std::memcpy(&n_triangles, bytes.data() + head - sizeof(n_triangles), sizeof(n_triangles));
      return bytes.size() == head + triangle * std::size_t(n_triangles);
    }

    /// Whether bytes are an IGES: columns 73 to 80 of the first line name the first line of the
    /// start section.
    bool
    is_iges(const std::string &bytes)
    {
      return bytes.size() > 80 && bytes[72] == 'S' && bytes.find_first_of("\r\n") >= 80
             && (begins_with(bytes, 73, "      1") || begins_with(bytes, 73, "0000001"));
    }
  } // namespace

  std::string
  merged_format(const std::string &bytes)
  {
    if (is_stl(bytes))
      return ".stl";
    if (is_iges(bytes))
      return ".iges";
    if (begins_with(bytes, 0, "    -1\n") || begins_with(bytes, 0, "    -1\r\n"))
      return ".unv";
    for (const auto &[text, extension] : beginnings)
      if (begins_with(bytes, 0, text))
        return extension;
    return "";
  }
} // namespace Exemplar
