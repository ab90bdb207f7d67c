// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_h
#define exemplar_mesh_h

#include <exemplar/mesh/mesh_inputs.h>

#include <deal.II/grid/tria.h>

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The tetrahedral rest mesh. Node i is the i-th node of the file, cell c its
  /// c-th tetrahedron; the Triangulation has the same numbering, and results go
  /// back to disk in it.
  class Mesh
  {
  public:
    /// Load as the parameters say, then as below.
    explicit Mesh(const MeshParameters &parameters);

    /// Multiply the nodes by `scale`, check, and build the Triangulation. `name` stands for the
    /// file in messages. Throws UserError with element or node numbers of the file for whatever
    /// is no valid body, and for a scale that is not positive.
    Mesh(MshFile contents, const std::string &name, double scale = 1.);

    unsigned int
    n_nodes() const
    {
      return static_cast<unsigned int>(contents.nodes.size());
    }

    unsigned int
    n_cells() const
    {
      return static_cast<unsigned int>(cells.size());
    }

    /// Positively oriented nodes of each tetrahedron.
    const std::vector<std::array<unsigned int, 4>> &
    get_cells() const
    {
      return cells;
    }

    /// Material id of each cell (physical tag of its volume, 0 = none).
    const std::vector<unsigned int> &
    get_material_ids() const
    {
      return material_ids;
    }

    /// The number of a cell in the mesh file.
    std::size_t
    element_number(const unsigned int cell) const
    {
      return element_numbers[cell];
    }

    /// Every boundary face; those without a physical surface have id 0.
    const std::vector<BoundaryFace> &
    get_boundary_faces() const
    {
      return boundary_faces;
    }

    const std::vector<dealii::Point<3>> &
    get_nodes() const
    {
      return contents.nodes;
    }

    /// The file as read (scaled), to write poses in the same numbering.
    const MshFile &
    get_contents() const
    {
      return contents;
    }

    const dealii::Triangulation<3> &
    get_triangulation() const
    {
      return triangulation;
    }

    /// The file the mesh came from; "box" if generated, "mesh" if made of arrays.
    const std::string &
    get_name() const
    {
      return name;
    }

    /// Warnings to show the user, e.g. re-oriented tetrahedra.
    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

    /// What the lengths of the file were multiplied by.
    double
    get_scale() const
    {
      return scale;
    }

    /// Diagonal of the bounding box [m].
    double
    diameter() const;

    /// Places of the nodes [m] in the pose of a file, which is checked as by the function of the
    /// same name, times the mesh's scale. In files of 10-node tetrahedra, here and below, also of
    /// the middles of edges_of().
    std::vector<dealii::Point<3>>
    read_pose(const std::filesystem::path &file) const;

    /// Places of the nodes [m] in one of `poses`, times the mesh's scale. Throws UserError,
    /// calling the parameter `key`, if it is not there or has another number of nodes.
    std::vector<dealii::Point<3>>
    find_pose(const NamedPoses &poses, const std::string &pose, const std::string &key) const;

    /// The inverse: the mesh with its nodes at `positions`, divided by the mesh's
    /// scale, with the file's numbers, order and tags. With places of the middles of edges_of()
    /// behind those of the nodes, the file gets 10-node tetrahedra.
    void
    write_pose(const std::vector<dealii::Point<3>> &positions,
               const std::filesystem::path         &file) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    std::vector<dealii::Point<3>>
    scaled(std::vector<dealii::Point<3>> nodes) const;

    void
    build_triangulation();

    MshFile                                  contents;
    std::string                              name;
    double                                   scale;
    std::vector<std::array<unsigned int, 4>> cells;
    std::vector<unsigned int>                material_ids;
    std::vector<std::size_t>                 element_numbers;
    std::vector<BoundaryFace>                boundary_faces;
    std::vector<std::string>                 warnings;
    dealii::Triangulation<3>                 triangulation;
  };
} // namespace Exemplar

#endif
