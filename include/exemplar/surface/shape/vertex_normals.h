// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vertex_normals_h
#define exemplar_vertex_normals_h

#include <exemplar/surface/shape/vectors.h>

#include <vector>

namespace Exemplar
{
  /// Unit normals at vertices, by vertex: means over the polygons, weighted by their angles there. A vertex of no polygon with
  /// an area has (0, 0, 1).
  std::vector<SpaceVector>
  vertex_normals(const std::vector<std::vector<unsigned int>> &polygons,
                 const std::vector<SpaceVector>               &vertices);
} // namespace Exemplar

#endif
