// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tetrahedra_inside_h
#define exemplar_tetrahedra_inside_h

#include <exemplar/surface/shape/triangle_surface.h>

namespace Exemplar
{
  /// Tetrahedra and their boundary.
  struct TetrahedralMesh
  {
    std::vector<SurfaceMesh::Vertex>         nodes;
    std::vector<std::array<unsigned int, 4>> cells;    ///< nodes; positive volume
    std::vector<unsigned int>                regions;  ///< one a cell, from 0
    TriangleSurface                          boundary; ///< triangles of nodes; vertices unused
  };

  /// Fill a closed surface, whose shells do not intersect, by gmsh (Delaunay); the surface's
  /// vertices are the first nodes, its triangles the boundary, and the cells inside are about as
  /// large as it has them outside. The n-th shell whose faces point away from what it encloses
  /// bounds region n, less the shells within it; a shell within it that is turned inwards bounds
  /// a cavity. Throws SolverFailure if gmsh cannot fill it.
  TetrahedralMesh
  fill(const TriangleSurface &surface);
} // namespace Exemplar

#endif
