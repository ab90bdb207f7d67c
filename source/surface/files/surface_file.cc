// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/mesh/foreign_formats.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/surface/files/surface_formats.h>
#include <exemplar/surface/files/surface_scanner.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>

namespace Exemplar
{
  namespace
  {
    std::string
    lower_case(std::string text)
    {
      std::transform(text.begin(), text.end(), text.begin(),
                     [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
      return text;
    }

    /// Bytes enough to recognise a format; empty if the file cannot be read.
    std::string
    first_bytes(const std::filesystem::path &file)
    {
      if (!reason_not_to_read(file).empty())
        return "";
      std::ifstream in(file, std::ios::binary);
      std::string   bytes(4096, '\0');
      in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      bytes.resize(static_cast<std::size_t>(in.gcount()));
      return bytes;
    }

    SurfaceMesh
    read_by_extension(const std::filesystem::path &file)
    {
      const std::string extension = lower_case(file.extension().string());
      if (!is_surface_file(file.string()))
      {
        const std::string bytes = first_bytes(file);
        if (bytes.empty() && std::filesystem::is_regular_file(file))
          throw UserError(
              file.string()
              + ": the file is empty. Export the surface again, as .obj, .ply or .stl.");
        const std::string remedy = remedy_of_surface(file, bytes);
        throw UserError(file.string() + ": a surface must be an .obj, .ply or .stl file, found "
                        + in_quotes(extension) + ". "
                        + (remedy.empty() ? "Export it in one of these formats." : remedy));
      }
      SurfaceScanner in(file);
      try
      {
        if (extension == ".obj")
          return read_obj(in);
        return extension == ".ply" ? read_ply(in) : read_stl(in);
      }
      catch (const UserError &)
      {
        if (const std::string remedy = remedy_of_content(file, in.all()); !remedy.empty())
          throw UserError(file.string() + ": the name ends in " + extension
                          + ", but the content does not fit. " + remedy);
        throw;
      }
    }

    void
    require_finite(const SurfaceMesh &surface, const std::string &name)
    {
      for (std::size_t i = 0; i < surface.vertices.size(); ++i)
        for (const double x : surface.vertices[i])
          if (!(std::abs(x) <= 1e100)) // squares and cubes are finite, too
            throw UserError(fmt::format(
                "{}: vertex {} of {} has a coordinate that is no finite number (or beyond 1e100). "
                "Correct or delete it in the program that made the file.",
                name, i + 1, surface.vertices.size()));
    }
  } // namespace

  void
  GroupedFaces::add(std::vector<unsigned int> vertices, const std::string &group)
  {
    if (surface.face_groups.empty() || surface.group_names[last_group] != group)
    {
      const auto added
          = index_of.emplace(group, static_cast<unsigned int>(surface.group_names.size()));
      if (added.second)
        surface.group_names.push_back(group);
      last_group = added.first->second;
    }
    surface.faces.push_back(std::move(vertices));
    surface.face_groups.push_back(last_group);
  }

  void
  GroupedFaces::finish()
  {
    if (surface.group_names.size() == 1 && surface.group_names[0].empty())
    {
      surface.group_names.clear();
      surface.face_groups.clear();
    }
  }

  void
  require_few(const SurfaceScanner &in, const std::size_t n, const std::string &what)
  {
    if (n > std::numeric_limits<unsigned int>::max() / 4)
      in.fail(fmt::format("more than {} {} are not supported. Reduce the surface.",
                          std::numeric_limits<unsigned int>::max() / 4, what));
  }

  SurfaceMesh
  read_surface(const std::filesystem::path &file)
  {
    SurfaceMesh surface = read_by_extension(file);
    if (surface.vertices.empty() || surface.faces.empty())
      throw UserError(fmt::format("{}: there are {} vertices and {} faces, which is no surface. "
                                  "Export the object as a mesh of polygons.",
                                  file.string(), surface.vertices.size(), surface.faces.size()));
    require_finite(surface, file.string());
    return surface;
  }
} // namespace Exemplar
