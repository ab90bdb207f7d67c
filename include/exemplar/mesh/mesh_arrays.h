// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_arrays_h
#define exemplar_mesh_arrays_h

#include <exemplar/mesh/mesh_inputs.h>

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The pieces of a mesh that no common face connects; empty if it is in one piece.
  struct MeshPieces
  {
    std::vector<unsigned int>
        of_cells; ///< the piece of each cell, in the order of their first cells
    std::vector<std::size_t> first_elements; ///< number in the file of each piece's first cell

    bool
    empty() const
    {
      return of_cells.empty();
    }
  };

  /// A checked mesh of tetrahedra or of triangles. Node i is the i-th node of the file, cell c its c-th tetrahedron, or of a
  /// shell its c-th triangle.
  struct MeshArrays
  {
    MshFile                                  contents; ///< the file as read, with scaled nodes [m]
    std::vector<std::array<unsigned int, 4>> cells;    ///< positively oriented; empty for a shell
    std::vector<std::array<unsigned int, 3>> triangles = {}; ///< of a shell
    std::vector<unsigned int>                material_ids;
    std::vector<std::size_t>                 element_numbers; ///< numbers in the file
    std::vector<BoundaryFace>                boundary_faces;
    /// Faces that a boundary id selects in addition: those between two cells, and faces of the boundary under further
    /// physical tags.
    std::vector<BoundaryFace> further_faces = {};
    MeshPieces                pieces;
    std::vector<std::string>  warnings; ///< to show the user
  };

  /// Multiply the nodes by `scale`, and check. `name` stands for the file in messages. Throws
  /// UserError with element or node numbers of the file for an invalid body, and for a scale that
  /// is not positive.
  MeshArrays
  check_mesh(MshFile contents, const std::string &name, double scale);

  /// The same for a shell: triangles that meet at edges in pairs, turned alike, in one piece or more. Boundary ids are those of the
  /// triangles, as the materials are.
  MeshArrays
  check_shell(MshFile contents, const std::string &name, double scale);

  /// Diagonal of the bounding box.
  double
  box_diagonal(const std::vector<dealii::Point<3>> &nodes);
} // namespace Exemplar

#endif
