// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/mesh/mesh_generation.h>
#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/mesh/mesh_joining.h>
#include <exemplar/mesh/msh_nodes.h>
#include <exemplar/mesh/quadratic_msh.h>

#include <fmt/core.h>

#include <numeric>

namespace Exemplar
{
  namespace
  {
    MshFile
    msh_of(const MeshParameters &parameters)
    {
      const std::filesystem::path path(parameters.file);
      if (path.extension() != ".geo")
        return read_mesh_file(path);
      MshFile msh = mesh_geo_file(path, parameters.allow_commands);
      drop_construction_points(msh, parameters.file);
      return msh;
    }

    MshFile
    with_corners_alone(MshFile msh, const std::string &name)
    {
      if (has_quadratic_tetrahedra(msh))
        take_corners(msh, name);
      return msh;
    }

    MshFile
    read_files(const MeshParameters &parameters)
    {
      std::vector<MshFile> meshes;
      for (const std::string &file : parameters.files)
        meshes.push_back(with_corners_alone(read_mesh_file(file), file));
      return join_meshes(std::move(meshes), parameters.placed);
    }

    /// Append an element between nodes that exist.
    template <std::size_t n>
    void
    add_element(MshFile                           &msh,
                const unsigned int                 type,
                const unsigned int                 tag,
                const std::array<unsigned int, n> &nodes)
    {
      for (const unsigned int node : nodes)
        if (node >= msh.nodes.size())
          throw UserError(fmt::format("The mesh has {} nodes, but a {} has node {}. Nodes are "
                                      "counted from 0: if these are from 1, subtract 1 from all.",
                                      msh.nodes.size(), find_msh_element_kind(type)->name, node));
      const int id = static_cast<int>(tag);
      msh.elements.push_back(
          { msh.elements.size() + 1, type, id, id, { nodes.begin(), nodes.end() } });
    }
  } // namespace

  MshFile
  load_mesh(const MeshParameters &parameters)
  {
    const bool has_file = !parameters.file.empty(), has_files = !parameters.files.empty();
    const bool has_box = parameters.generator == MeshGenerator::box;
    if (has_files && (has_file || has_box))
      throw UserError("Mesh: both Files and " + std::string(has_file ? "File" : "Generator")
                      + " are given. Keep one of them.");
    if (has_files)
      return read_files(parameters);
    if (has_file == has_box)
      throw UserError(std::string("Mesh: ")
                      + (has_file ? "both File and Generator are given" : "no mesh is given")
                      + ". Set Mesh/File to a mesh (" + mesh_extensions
                      + ", .geo) or to a surface, or set "
                        "Mesh/Generator = box; exactly one of them.");
    if (has_box)
      return generate_box(parameters.box_size, parameters.box_cells);
    return with_corners_alone(msh_of(parameters), parameters.name());
  }

  MshFile
  make_msh(std::vector<dealii::Point<3>>                   nodes,
           const std::vector<std::array<unsigned int, 4>> &cells,
           const std::vector<unsigned int>                &material_ids,
           const std::vector<BoundaryFace>                &boundary_faces)
  {
    if (!material_ids.empty() && material_ids.size() != cells.size())
      throw UserError(fmt::format(
          "The mesh has {} cells, but {} material ids. Give one for each cell, or none.",
          cells.size(), material_ids.size()));
    MshFile msh;
    msh.nodes = std::move(nodes);
    msh.node_numbers.resize(msh.nodes.size());
    std::iota(msh.node_numbers.begin(), msh.node_numbers.end(), 1);
    msh.elements.reserve(boundary_faces.size() + cells.size());
    for (const BoundaryFace &face : boundary_faces)
      add_element(msh, MshElementType::triangle, face.boundary_id, face.nodes);
    for (std::size_t c = 0; c < cells.size(); ++c)
      add_element(msh, MshElementType::tetrahedron, material_ids.empty() ? 0 : material_ids[c],
                  cells[c]);
    return msh;
  }
} // namespace Exemplar
