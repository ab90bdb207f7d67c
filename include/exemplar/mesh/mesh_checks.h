// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_checks_h
#define exemplar_mesh_checks_h

#include <exemplar/mesh/mesh_arrays.h>
#include <exemplar/mesh/msh_file.h>

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Whether a triangle is more than a line or a point, but for rounding; false for places that are no numbers.
  bool
  has_area(const dealii::Point<3> &a, const dealii::Point<3> &b, const dealii::Point<3> &c);

  /// Checks of a mesh on plain arrays, which report errors with the numbers of its file. All throw
  /// UserError. In the order below each may rely on the ones before.

  /// The tetrahedra of a file, in its order.
  struct Tetrahedra
  {
    std::vector<std::array<unsigned int, 4>> nodes;           ///< indices
    std::vector<unsigned int>                material_ids;    ///< |physical tag|
    std::vector<std::size_t>                 element_numbers; ///< numbers in the file
  };

  /// A face of one tetrahedron.
  struct CellFace
  {
    std::array<unsigned int, 3> nodes; ///< ascending
    unsigned int                cell;
    unsigned int                opposite; ///< the cell's other node
  };

  /// "3, 7, 9, 12, 15 and 4 more"
  std::string
  list_numbers(const std::vector<std::size_t> &numbers);

  /// Extract the tetrahedra of a file. Refuses a file without any, and volume or surface elements
  /// of any other kind than linear tetrahedra and triangles.
  Tetrahedra
  extract_tetrahedra(const MshFile &contents, const std::string &name);

  /// Swap two nodes of every tetrahedron of negative volume; returns their element
  /// numbers. Refuses flat tetrahedra: volume <= 1e-12 (longest edge)^3, which for
  /// the regular one is 0.12.
  std::vector<std::size_t>
  orient_tetrahedra(const MshFile &contents, const std::string &name, Tetrahedra &tetrahedra);

  /// Refuse coordinates [m] that are not finite, or so large that energies would not be: `nodes`
  /// are places of the nodes of `contents`, and maybe of the middles of edges after them.
  void
  check_places(const std::vector<dealii::Point<3>> &nodes,
               const MshFile                       &contents,
               const std::string                   &name);

  /// Make metres of the nodes' coordinates and check them. Throws UserError for a scale that is not positive, and as
  /// check_places().
  void
  scale_nodes(MshFile &contents, const std::string &name, double scale);

  /// Refuse nodes that belong to no tetrahedron: they would have no stiffness.
  void
  check_orphan_nodes(const MshFile     &contents,
                     const std::string &name,
                     const Tetrahedra  &tetrahedra);

  /// All faces of all cells, sorted by their nodes, so that neighbours follow one
  /// another.
  std::vector<CellFace>
  sorted_faces(const Tetrahedra &tetrahedra);

  /// Refuse two tetrahedra with the same nodes, and faces that more than two share.
  void
  check_faces(const MshFile               &contents,
              const std::string           &name,
              const Tetrahedra            &tetrahedra,
              const std::vector<CellFace> &faces);

  /// Refuse neighbours on the same side of their common face: one of them is inverted. The order of
  /// a cell's nodes does not tell, because it may differ between valid cells, too. `swapped` are
  /// the element numbers that orient_tetrahedra() has returned.
  void
  check_overlaps(const MshFile                  &contents,
                 const std::string              &name,
                 const Tetrahedra               &tetrahedra,
                 const std::vector<CellFace>    &faces,
                 const std::vector<std::size_t> &swapped);

  /// The pieces of the mesh, in each of which cells are connected through faces; none for a mesh in one piece. Throws
  /// UserError for pieces that have nodes in common, like hinges.
  MeshPieces
  find_pieces(const MshFile               &contents,
              const std::string           &name,
              const Tetrahedra            &tetrahedra,
              const std::vector<CellFace> &faces);
} // namespace Exemplar

#endif
