// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_mesh_h
#define exemplar_surface_mesh_h

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// A surface of polygons as a file has it: vertices in the file's order, unit and axes.
  struct SurfaceMesh
  {
    using Vertex = std::array<double, 3>;

    std::vector<Vertex>                    vertices;
    std::vector<std::vector<unsigned int>> faces; ///< vertices from 0, at least three each
    /// The group of each face, an index of group_names; empty where the file has no groups.
    std::vector<unsigned int> face_groups;
    std::vector<std::string>  group_names;

    /// Further data of the faces in an .obj: texture points, the texture points of each face's
    /// corners (empty for faces without), and the lines (g, usemtl, o, s, mtllib) that stand before
    /// a face, by its number.
    std::vector<std::array<double, 2>>               texture_points      = {};
    std::vector<std::vector<unsigned int>>           face_texture_points = {};
    std::vector<std::pair<std::size_t, std::string>> face_statements     = {};
  };

  /// Reads .obj, .ply (ASCII or binary) or .stl (ASCII or binary, equal corners joined), by the
  /// extension. Throws UserError with the line or byte for what is no such file.
  SurfaceMesh
  read_surface(const std::filesystem::path &file);
} // namespace Exemplar

#endif
