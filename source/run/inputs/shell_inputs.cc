// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/run/inputs/shell_inputs.h>
#include <exemplar/surface/shape/triangle_surface.h>

#include <fmt/core.h>

#include <numeric>

namespace Exemplar
{
  namespace
  {
    /// Triangles of a surface as elements, whose physical tags are the numbers of its groups from 1.
    MshFile
    msh_of_surface(const SurfaceMesh &surface)
    {
      const TriangleSurface triangles = triangulate(surface);
      MshFile               msh;
      for (const auto &[x, y, z] : surface.vertices)
        msh.nodes.emplace_back(x, y, z);
      msh.node_numbers.resize(msh.nodes.size());
      std::iota(msh.node_numbers.begin(), msh.node_numbers.end(), 1);
      const bool has_groups = surface.group_names.size() > 1;
      for (std::size_t t = 0; t < triangles.triangles.size(); ++t)
      {
        const auto &[a, b, c] = triangles.triangles[t];
        const int tag         = has_groups ? static_cast<int>(triangles.groups[t]) + 1 : 0;
        msh.elements.push_back({ t + 1, MshElementType::triangle, tag, tag, { a, b, c } });
      }
      for (std::size_t g = 0; has_groups && g < surface.group_names.size(); ++g)
        msh.physical_names[{ 2, static_cast<int>(g) + 1 }] = surface.group_names[g];
      return msh;
    }

    MshFile
    read_triangles(const std::filesystem::path &file)
    {
      return is_surface_file(file.string()) ? msh_of_surface(read_surface(file))
                                            : read_mesh_file(file);
    }

    std::vector<const MshElement *>
    triangles_of(const MshFile &msh)
    {
      std::vector<const MshElement *> triangles;
      for (const MshElement &element : msh.elements)
        if (element.type == MshElementType::triangle)
          triangles.push_back(&element);
      return triangles;
    }
  } // namespace

  MshFile
  load_shell(const MeshParameters &parameters)
  {
    if (parameters.file.empty())
      throw UserError("Mesh: no mesh is given. With Mesh/Kind = shell, set Mesh/File to a surface "
                      "(.obj, .ply or .stl) or "
                      "to a .msh of triangles.");
    return read_triangles(parameters.file);
  }

  std::vector<dealii::Point<3>>
  read_shell_pose(const std::filesystem::path &file,
                  const MshFile               &mesh,
                  const std::string           &mesh_name)
  {
    MshFile           pose = read_triangles(file);
    const std::string prefix
        = file.string() + " is no pose of " + mesh_name + ": ",
        remedy = " A pose of a shell has the vertices and faces of the shell, in the same order.";
    const auto expected = triangles_of(mesh), found = triangles_of(pose);
    if (pose.nodes.size() != mesh.nodes.size())
      throw UserError(fmt::format("{}it has {} vertices, the mesh has {}.{}", prefix,
                                  pose.nodes.size(), mesh.nodes.size(), remedy));
    if (found.size() != expected.size())
      throw UserError(fmt::format("{}it has {} triangles, the mesh has {}.{}", prefix, found.size(),
                                  expected.size(), remedy));
    for (std::size_t t = 0; t < found.size(); ++t)
      if (found[t]->nodes != expected[t]->nodes)
        throw UserError(fmt::format("{}triangle {} has other vertices than that of the mesh.{}",
                                    prefix, t + 1, remedy));
    std::vector<dealii::Point<3>> places = std::move(pose.nodes);
    places.insert(places.end(), pose.normal_tips.begin(), pose.normal_tips.end());
    return places;
  }
} // namespace Exemplar
