// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/surface/filling/surface_msh.h>
#include <exemplar/surface/shape/surface_edges.h>

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    /// Names that are all whole numbers are ids; others get theirs in order, from 1.
    std::vector<unsigned int>
    ids_of(const std::vector<std::string> &names)
    {
      std::vector<unsigned int> ids, in_order;
      for (const std::string &name : names)
      {
        unsigned int id  = 0;
        const char  *end = name.data() + name.size();
        in_order.push_back(static_cast<unsigned int>(in_order.size() + 1));
        const auto done = std::from_chars(name.data(), end, id);
        if (done.ec == std::errc() && done.ptr == end && id < 2000000000U)
          ids.push_back(id);
      }
      const std::set<unsigned int> distinct(ids.begin(), ids.end());
      return distinct.size() == names.size() ? ids : in_order;
    }

    /// Whether each triangle of the boundary has cells on one side only: others lie between
    /// regions.
    std::vector<bool>
    outer_triangles(const TetrahedralMesh &mesh)
    {
      using Triangle    = std::array<unsigned int, 3>;
      const auto sorted = [](Triangle t)
      {
        std::sort(t.begin(), t.end());
        return t;
      };
      std::map<Triangle, unsigned int> n_cells;
      for (const Triangle &t : mesh.boundary.triangles)
        n_cells[sorted(t)] = 0;
      for (const auto &c : mesh.cells)
        for (unsigned int k = 0; k < 4; ++k)
        {
          const auto found
              = n_cells.find(sorted({ { c[(k + 1) % 4], c[(k + 2) % 4], c[(k + 3) % 4] } }));
          if (found != n_cells.end())
            ++found->second;
        }
      std::vector<bool> outer;
      for (const Triangle &t : mesh.boundary.triangles)
        outer.push_back(n_cells[sorted(t)] == 1);
      return outer;
    }

    /// The group of all triangles of each shell that bounds a region from outside, in the order of
    /// the regions; none where a shell has several.
    std::vector<std::set<unsigned int>>
    groups_around_regions(const TetrahedralMesh &mesh)
    {
      TriangleSurface surface = mesh.boundary;
      surface.vertices        = mesh.nodes;
      std::vector<unsigned int> shells;
      const unsigned int        n_shells = number_shells(surface, sorted_sides(surface), shells);
      std::vector<std::set<unsigned int>> groups;
      for (unsigned int shell = 0; shell < n_shells; ++shell)
        if (const TriangleSurface part = shell_of(surface, shells, shell);
            enclosed_volume(part) > 0.)
          groups.emplace_back(part.groups.begin(), part.groups.end());
      return groups;
    }
  } // namespace

  std::vector<std::string>
  names_of_regions(const TetrahedralMesh &mesh, const std::vector<std::string> &group_names)
  {
    const auto                          groups = groups_around_regions(mesh);
    std::map<std::string, unsigned int> n_regions;
    std::vector<std::string>            names;
    for (const auto &around : groups)
    {
      const bool has_name = around.size() == 1 && *around.begin() < group_names.size();
      names.push_back(has_name ? group_names[*around.begin()] : "");
      ++n_regions[names.back()];
    }
    for (std::size_t region = 0; region < names.size(); ++region)
      if (names.size() == 1)
        names[region] = "body";
      else if (names[region].empty() || n_regions[names[region]] > 1)
        names[region] = fmt::format("shell {}", region + 1);
    return names;
  }

  Materials
  materials_by_regions(const TetrahedralMesh &mesh, const std::vector<std::string> &region_names)
  {
    const std::vector<unsigned int> ids = ids_of(region_names);
    Materials                       materials;
    for (const unsigned int region : mesh.regions)
    {
      materials.of_cell.push_back(ids[region]);
      materials.names[ids[region]] = region_names[region];
    }
    return materials;
  }

  MshFile
  make_surface_msh(const TetrahedralMesh          &mesh,
                   const std::vector<std::string> &group_names,
                   const Materials                &materials)
  {
    const auto names = group_names.empty() ? std::vector<std::string>{ "surface" } : group_names;
    const auto ids   = ids_of(names);
    std::vector<dealii::Point<3>> nodes;
    for (const auto &node : mesh.nodes)
      nodes.emplace_back(node[0], node[1], node[2]);
    std::vector<BoundaryFace> faces;
    const std::vector<bool>   outer = outer_triangles(mesh);
    for (std::size_t t = 0; t < mesh.boundary.triangles.size(); ++t)
      if (outer[t])
        faces.push_back({ mesh.boundary.triangles[t], ids[mesh.boundary.groups[t]] });
    MshFile msh = make_msh(std::move(nodes), mesh.cells, materials.of_cell, faces);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (ids[i] > 0 && !names[i].empty())
        msh.physical_names[{ 2, static_cast<int>(ids[i]) }] = names[i];
    for (const auto &[id, name] : materials.names)
      if (id > 0 && !name.empty())
        msh.physical_names[{ 3, static_cast<int>(id) }] = name;
    return msh;
  }
} // namespace Exemplar
