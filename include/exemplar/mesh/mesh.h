// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_h
#define exemplar_mesh_h

#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/mesh/msh_file.h>

#include <deal.II/grid/tria.h>

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A boundary triangle: three node indices, counterclockwise seen from outside,
  /// and its boundary id.
  struct BoundaryFace
  {
    std::array<unsigned int, 3> nodes;
    unsigned int                boundary_id;
  };

  /// The tetrahedral rest mesh. Node i is the i-th node of the file, cell c its
  /// c-th tetrahedron; the Triangulation has the same numbering, and results go
  /// back to disk in it.
  class Mesh
  {
  public:
    /// Read, mesh with gmsh (.geo) or generate as the parameters say, check, and
    /// build the Triangulation. Throws UserError with element or node numbers of
    /// the file for whatever is no valid body.
    explicit Mesh(const MeshParameters &parameters);

    /// Build from contents at hand; `name` stands for the file in messages.
    Mesh(MshFile contents, const std::string &name);

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

    /// The file the mesh came from; "box" if generated.
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

    /// Diagonal of the bounding box [m].
    double
    diameter() const;

    /// Node coordinates of a pose on this mesh: the file must have the same node
    /// numbers and tetrahedra in the same order. They are multiplied by the
    /// mesh's scale. Throws UserError naming the first difference.
    std::vector<dealii::Point<3>>
    read_pose(const std::filesystem::path &file) const;

    /// The inverse: the mesh with its nodes at `positions`, divided by the mesh's
    /// scale, with the file's numbers, order and tags.
    void
    write_pose(const std::vector<dealii::Point<3>> &positions,
               const std::filesystem::path         &file) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// Fill what follows from `contents`, or throw.
    void
    build();

    void
    build_triangulation();

    MshFile                                  contents;
    std::string                              name;
    double                                   scale = 1.;
    std::vector<std::array<unsigned int, 4>> cells;
    std::vector<unsigned int>                material_ids;
    std::vector<BoundaryFace>                boundary_faces;
    std::vector<std::string>                 warnings;
    dealii::Triangulation<3>                 triangulation;
  };
} // namespace Exemplar

#endif
