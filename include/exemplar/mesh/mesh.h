// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_h
#define exemplar_mesh_h

#include <exemplar/mesh/mesh_part.h>

#include <deal.II/base/array_view.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The rest mesh: tetrahedra, or the triangles of a shell. Node i is the i-th node of the file, cell c its c-th tetrahedron
  /// or triangle; the Triangulation, which tetrahedra alone have, has the same numbering, and results go back to disk in it.
  /// Each process has a part of a distributed mesh.
  class Mesh
  {
  public:
    /// Load a mesh by the parameters, then as below.
    explicit Mesh(const MeshParameters &parameters);

    /// Multiply the nodes by `scale`, check, and build the Triangulation. `name` stands for the
    /// file in messages. Throws UserError with element or node numbers of the file for an invalid
    /// body, and for a scale that is not positive.
    Mesh(MshFile            contents,
         const std::string &name,
         double             scale = 1.,
         MeshKind           kind  = MeshKind::solid);

    /// The part of a process. Collective.
    Mesh(MeshPart part, const std::string &name, double scale);

    unsigned int
    n_nodes() const
    {
      return static_cast<unsigned int>(arrays.contents.nodes.size());
    }

    unsigned int
    n_cells() const
    {
      return static_cast<unsigned int>(arrays.material_ids.size());
    }

    bool
    is_shell() const
    {
      return !arrays.triangles.empty();
    }

    /// Facts of the whole body, of which this may be a part.
    const WholeMesh &
    whole() const
    {
      return of_whole;
    }

    /// The order of this process' cells among those of the body.
    const CellOrder &
    cell_order() const
    {
      return order;
    }

    /// How many pieces the whole body has that no common face connects.
    unsigned int
    n_pieces() const
    {
      return of_whole.pieces.empty() ? 1 : of_whole.pieces.first_elements.size();
    }

    /// The piece of a cell of this process.
    unsigned int
    piece_of(const unsigned int cell) const
    {
      return of_whole.pieces.empty() ? 0 : of_whole.pieces.of_cells[order.in_file()[cell]];
    }

    /// The exchange with the processes that have the other parts.
    const Exchange &
    exchange() const
    {
      return *with_others;
    }

    /// The nodes of a tetrahedron or of a shell's triangle.
    dealii::ArrayView<const unsigned int>
    corners(const unsigned int cell) const
    {
      return is_shell() ? dealii::ArrayView<const unsigned int>(arrays.triangles[cell].data(), 3)
                        : dealii::ArrayView<const unsigned int>(arrays.cells[cell].data(), 4);
    }

    /// The triangles of a shell.
    const std::vector<std::array<unsigned int, 3>> &
    get_triangles() const
    {
      return arrays.triangles;
    }

    /// Positively oriented nodes of each tetrahedron; empty for a shell.
    const std::vector<std::array<unsigned int, 4>> &
    get_cells() const
    {
      return arrays.cells;
    }

    /// Material id of each cell (physical tag of its volume, 0 = none).
    const std::vector<unsigned int> &
    get_material_ids() const
    {
      return arrays.material_ids;
    }

    /// The number of a cell in the mesh file.
    std::size_t
    element_number(const unsigned int cell) const
    {
      return arrays.element_numbers[cell];
    }

    /// Every boundary face; those without a physical surface have id 0.
    const std::vector<BoundaryFace> &
    get_boundary_faces() const
    {
      return arrays.boundary_faces;
    }

    /// Faces that a boundary id selects in addition: those between two cells, as the file turns them, and faces of the
    /// boundary under further physical tags.
    const std::vector<BoundaryFace> &
    get_further_faces() const
    {
      return arrays.further_faces;
    }

    const std::vector<dealii::Point<3>> &
    get_nodes() const
    {
      return arrays.contents.nodes;
    }

    /// The file as read (scaled), to write poses in the same numbering; for a part of a mesh its
    /// nodes alone, without elements.
    const MshFile &
    get_contents() const
    {
      return arrays.contents;
    }

    /// The file of the whole body as read (scaled); only at the root.
    const MshFile &
    contents_of_whole() const
    {
      return file == nullptr ? arrays.contents : *file;
    }

    /// The triangulation, built on the first call: a process that only distributes the mesh needs
    /// none. Collective.
    const dealii::Triangulation<3> &
    get_triangulation() const;

    /// The file as read (scaled), moved out of a mesh that is no longer needed.
    MshFile
    take_contents() &&
    {
      return std::move(arrays.contents);
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
      return arrays.warnings;
    }

    /// Factor of the lengths in the file.
    double
    get_scale() const
    {
      return scale;
    }

    /// Diagonal of the bounding box of the body [m].
    double
    diameter() const
    {
      return of_whole.diameter;
    }

    /// Places of the nodes [m] in the pose of a file, times the mesh's scale; checked as by the
    /// free function of this name. For files of 10-node tetrahedra, here and below, also places of
    /// the middles of edges_of().
    std::vector<dealii::Point<3>>
    read_pose(const std::filesystem::path &file) const;

    /// Places of the nodes [m] in one of `poses`, times the mesh's scale. Throws UserError, calling
    /// the parameter `key`, if it is missing or has another number of nodes.
    std::vector<dealii::Point<3>>
    find_pose(const NamedPoses &poses, const std::string &pose, const std::string &key) const;

    /// Write the whole mesh with its nodes at `positions`, divided by the mesh's scale, with the
    /// file's numbers, order and tags, as read_pose() reads it. With places of the middles of
    /// edges_of() behind those of the nodes, the file gets 10-node tetrahedra. `comment` as in
    /// write_msh().
    void
    write_pose(const std::vector<dealii::Point<3>> &positions,
               const std::filesystem::path         &file,
               const std::string                   &comment = "") const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    MeshArrays                      arrays;
    std::string                     name;
    double                          scale;
    WholeMesh                       of_whole;
    std::shared_ptr<const Exchange> shared;      ///< null for a single process
    const Exchange                 *with_others; ///< `shared`, or that of a single process
    CellOrder                       order;
    std::shared_ptr<const MshFile>  file; ///< only at the root of several processes
    mutable std::unique_ptr<dealii::Triangulation<3>> triangulation; ///< null: not yet built
  };

  /// Element numbers in the mesh file, in its order, of cells of the whole body, of which each
  /// process gives its own. Collective.
  std::vector<std::size_t>
  whole_elements(const Mesh &mesh, const std::vector<unsigned int> &own_cells);
} // namespace Exemplar

#endif
