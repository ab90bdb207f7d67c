// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_sheet_crossings_h
#define exemplar_sheet_crossings_h

#include <exemplar/surface/shape/triangle_surface.h>

#include <utility>

namespace Exemplar
{
  /// Where the sheets of a surface cross, in any place of its vertices.
  class SheetCrossings
  {
  public:
    /// Triangles that are faulty by themselves (edges of more than two, turned ones) are not looked at.
    explicit SheetCrossings(const TriangleSurface &surface);

    /// Pairs of triangles that cross, by their numbers in the surface.
    std::vector<std::pair<unsigned int, unsigned int>>
    pairs(const std::vector<SurfaceMesh::Vertex> &vertices) const;

  private:
    TriangleSurface           sound;   ///< what is looked at
    std::vector<unsigned int> numbers; ///< of its triangles, in the surface
  };

  /// Whether sheets cross where the surface has its vertices.
  bool
  has_crossing_sheets(const SurfaceMesh &surface);
} // namespace Exemplar

#endif
