// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_sheet_crossings_h
#define exemplar_sheet_crossings_h

#include <exemplar/surface/shape/triangle_surface.h>

#include <utility>

namespace Exemplar
{
  /// Finds crossings between sheets of a surface, for any positions of its vertices.
  class SheetCrossings
  {
  public:
    /// Leaves out triangles that are faulty by themselves (edges of more than two triangles, turned
    /// triangles).
    explicit SheetCrossings(const TriangleSurface &surface);

    /// Pairs of triangles that cross, by their numbers in the surface.
    std::vector<std::pair<unsigned int, unsigned int>>
    pairs(const std::vector<SurfaceMesh::Vertex> &vertices) const;

  private:
    TriangleSurface           sound;   ///< the surface without faulty triangles
    std::vector<unsigned int> numbers; ///< of each triangle of `sound`, its number in the surface
  };

  /// Whether sheets cross at the surface's own vertices.
  bool
  has_crossing_sheets(const SurfaceMesh &surface);
} // namespace Exemplar

#endif
