// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_angles_h
#define exemplar_cell_angles_h

#include <exemplar/surface/filling/tetrahedra_inside.h>
#include <exemplar/surface/shape/vectors.h>

namespace Exemplar
{
  /// The smallest and the largest of the six angles between the faces of a tetrahedron [degrees].
  std::pair<double, double>
  dihedral_angles(const std::array<SpaceVector, 4> &corners);

  std::array<SpaceVector, 4>
  corners_of(const TetrahedralMesh &mesh, std::size_t cell);

  /// Dihedral angles of the cells of a mesh [degrees].
  struct CellAngles
  {
    double      smallest = 180., percentile_1 = 0., median = 0.; ///< of the cells' smallest angles
    double      largest            = 0.;
    std::size_t n_boundary_slivers = 0; ///< cells with a boundary node and an angle below 3 degrees
    std::size_t n_slivers          = 0; ///< all cells with such an angle
  };

  /// Cells with a smaller dihedral angle are slivers [degrees].
  constexpr double sliver_angle = 3.;

  CellAngles
  measure_angles(const TetrahedralMesh &mesh);

  /// What remove_slivers() may do with boundary nodes.
  enum class BoundaryNodes
  {
    kept,
    moved_slightly ///< by 10 % of their shortest boundary edge, if they belong to slivers and to no plane
  };

  /// Move inner nodes of cells with angles below 8 degrees to places where the worst cell around them is
  /// better, and remove flat cells that have two faces on the boundary, which flips the edge
  /// between these. Nodes and cells for which this has no effect are kept. Returns the number of
  /// cells removed.
  std::size_t
  remove_slivers(TetrahedralMesh &mesh, BoundaryNodes boundary_nodes);
} // namespace Exemplar

#endif
