// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_inputs_h
#define exemplar_mesh_inputs_h

#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/mesh/msh_file.h>

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

// Inputs of meshes and poses: files, or arrays instead of them.

namespace Exemplar
{
  /// Poses by the names that parameters use: places of all nodes in the mesh's order and unit
  /// (before Mesh/Scale). Places of the middles of edges_of() may follow.
  using NamedPoses = std::map<std::string, std::vector<dealii::Point<3>>>;

  /// Indices of nodes, counted from 0, by the FILE of "nodes FILE".
  using NamedNodes = std::map<std::string, std::vector<unsigned int>>;

  /// A triangle of the boundary: three node indices, and its boundary id. In a Mesh the nodes are
  /// counterclockwise seen from outside.
  struct BoundaryFace
  {
    std::array<unsigned int, 3> nodes;
    unsigned int                boundary_id;

    /// Serialise by boost's archives, by which processes send faces to each other.
    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &nodes &boundary_id;
    }
  };

  /// Read, mesh by gmsh (.geo) or generate a mesh by the parameters; not scaled. Throws UserError
  /// unless there is exactly one of file and generator.
  MshFile
  load_mesh(const MeshParameters &parameters);

  /// A mesh from arrays: n nodes [m], cells as four indices of nodes from 0 to n - 1, a material id
  /// for each cell (none: all 0), and an id for those triangles of the boundary that have one.
  /// Nodes, triangles and cells are numbered from 1 in this order. Throws UserError for an index
  /// that is too large and for a number of material ids that is not that of the cells.
  MshFile
  make_msh(std::vector<dealii::Point<3>>                   nodes,
           const std::vector<std::array<unsigned int, 4>> &cells,
           const std::vector<unsigned int>                &material_ids   = {},
           const std::vector<BoundaryFace>                &boundary_faces = {});

  /// Places of the nodes in a pose of `mesh`, not scaled: the file must have the same node
  /// numbers and tetrahedra in the same order. If these have 10 nodes, places of the middles of
  /// edges_of() follow. Throws UserError naming the first difference;
  /// `mesh_name` stands for the mesh there. Of a mesh of several files the pose may be of one, see pose_of_one_file().
  /// What the reader has to say, MshFile::note, goes to `note` unless that is null.
  std::vector<dealii::Point<3>>
  read_pose(const std::filesystem::path &file,
            const MshFile               &mesh,
            const std::string           &mesh_name,
            std::string                 *note = nullptr);

  /// Indices of the nodes that a file lists by their numbers in `mesh`, ascending: a text of
  /// numbers between blanks, commas or semicolons, with comments from # to the end of the line, or
  /// an array that numpy.save() has written. Throws UserError, calling the list `key`.
  std::vector<unsigned int>
  read_nodes(const std::filesystem::path &file,
             const MshFile               &mesh,
             const std::string           &mesh_name,
             const std::string           &key);
} // namespace Exemplar

#endif
