// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/mesh/mesh_edges.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/mesh/mesh_joining.h>
#include <exemplar/mesh/quadratic_msh.h>

#include <fmt/core.h>

namespace Exemplar
{
  namespace
  {
    const char *const pose_remedy
        = " A pose must be a final.msh that exemplar wrote for this same mesh, or what exemplar "
          "pose "
          "makes of a posed surface on it; meshing the posed shape anew gives other nodes.";

    void
    compare_node_numbers(const MshFile &mesh, const MshFile &pose, const std::string &prefix)
    {
      if (pose.nodes.size() != mesh.nodes.size())
        throw UserError(fmt::format("{}it has {} nodes, the mesh has {}.{}", prefix,
                                    pose.nodes.size(), mesh.nodes.size(), pose_remedy));
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        if (pose.node_numbers[i] != mesh.node_numbers[i])
          throw UserError(
              fmt::format("{}the node at position {} has the number {}, in the mesh {}.{}", prefix,
                          i + 1, pose.node_numbers[i], mesh.node_numbers[i], pose_remedy));
    }

    std::vector<const MshElement *>
    tetrahedra_of(const MshFile &msh)
    {
      std::vector<const MshElement *> tetrahedra;
      for (const MshElement &element : msh.elements)
        if (element.type == MshElementType::tetrahedron)
          tetrahedra.push_back(&element);
      return tetrahedra;
    }

    std::string
    node_list(const MshFile &msh, const MshElement &element)
    {
      std::vector<std::size_t> numbers;
      for (const std::size_t node : element.nodes)
        numbers.push_back(msh.node_numbers[node]);
      return list_numbers(numbers);
    }

    void
    compare_tetrahedra(const MshFile &mesh, const MshFile &pose, const std::string &prefix)
    {
      const auto expected = tetrahedra_of(mesh);
      const auto found    = tetrahedra_of(pose);
      if (found.size() != expected.size())
        throw UserError(fmt::format("{}it has {} tetrahedra, the mesh has {}.{}", prefix,
                                    found.size(), expected.size(), pose_remedy));
      for (std::size_t i = 0; i < expected.size(); ++i)
        if (found[i]->nodes != expected[i]->nodes)
          throw UserError(fmt::format(
              "{}tetrahedron {} (element {}) has the nodes {}, in the mesh (element {}) {}.{}",
              prefix, i + 1, found[i]->number, node_list(pose, *found[i]), expected[i]->number,
              node_list(mesh, *expected[i]), pose_remedy));
    }
  } // namespace

  std::vector<dealii::Point<3>>
  read_pose(const std::filesystem::path &file,
            const MshFile               &mesh,
            const std::string           &mesh_name,
            std::string                 *note)
  {
    MshFile pose = read_mesh_file(file);
    if (note != nullptr)
      *note = pose.note;
    const std::string prefix = file.string() + " is no pose of " + mesh_name + ": ";
    if (!has_quadratic_tetrahedra(pose))
      if (auto places = pose_of_one_file(pose, mesh, prefix))
        return std::move(*places);
    if (has_quadratic_tetrahedra(pose))
      return quadratic_pose(pose, mesh, prefix);
    compare_node_numbers(mesh, pose, prefix);
    compare_tetrahedra(mesh, pose, prefix);
    return std::move(pose.nodes);
  }

  namespace
  {
    std::vector<dealii::Point<3>>
    scaled(std::vector<dealii::Point<3>> nodes, const Mesh &mesh)
    {
      for (auto &node : nodes)
        node *= mesh.get_scale();
      check_places(nodes, mesh.get_contents(), mesh.get_name());
      return nodes;
    }
  } // namespace

  std::vector<dealii::Point<3>>
  Mesh::read_pose(const std::filesystem::path &file) const
  {
    return scaled(Exemplar::read_pose(file, arrays.contents, name), *this);
  }

  std::vector<dealii::Point<3>>
  Mesh::find_pose(const NamedPoses &poses, const std::string &pose, const std::string &key) const
  {
    const auto found = poses.find(pose);
    if (found == poses.end())
      throw UserError(key + ": there is no pose '" + pose
                      + "' among the inputs. Hand it in by this name, or read it from a file.");
    const std::size_t n = found->second.size();
    const std::size_t n_edges
        = is_shell() ? edges_of(arrays.triangles).size() : edges_of(arrays.cells).size();
    if (n != n_nodes() && n != n_nodes() + n_edges)
      throw UserError(
          fmt::format("{}: the pose '{}' has {} nodes, the mesh {}. Hand in a place for each node.",
                      key, pose, n, n_nodes()));
    return scaled(found->second, *this);
  }

  void
  Mesh::write_pose(const std::vector<dealii::Point<3>> &positions,
                   const std::filesystem::path         &file_path,
                   const std::string                   &comment) const
  {
    const MshFile                &contents = contents_of_whole();
    std::vector<dealii::Point<3>> places   = positions;
    for (dealii::Point<3> &place : places)
      place /= scale;
    if (is_shell())
    {
      MshFile    pose  = contents;
      const auto first = places.begin() + static_cast<std::ptrdiff_t>(contents.nodes.size());
      pose.normal_tips = { first, places.end() };
      pose.nodes       = { places.begin(), first };
      write_msh(pose, file_path, comment);
      return;
    }
    if (places.size() > contents.nodes.size())
    {
      const auto edges
          = edges_of(file == nullptr ? arrays.cells : extract_tetrahedra(contents, name).nodes);
      write_msh(with_middles(contents, edges, places), file_path, comment);
      return;
    }
    AssertDimension(places.size(), contents.nodes.size());
    MshFile pose = contents;
    pose.nodes   = std::move(places);
    write_msh(pose, file_path, comment);
  }
} // namespace Exemplar
