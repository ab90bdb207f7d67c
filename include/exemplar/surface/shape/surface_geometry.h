// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_geometry_h
#define exemplar_surface_geometry_h

#include <exemplar/surface/shape/triangle_surface.h>

#include <memory>
#include <utility>

// Geometric queries that CGAL answers.

namespace Exemplar
{
  /// Pairs of triangles that intersect, beyond the edge or vertex that they share. Precondition:
  /// no edge has more than two triangles, and those go through it in opposite directions.
  std::vector<std::pair<unsigned int, unsigned int>>
  self_intersections(const TriangleSurface &surface);

  /// Finds the nearest point of a surface.
  class NearestTriangle
  {
  public:
    explicit NearestTriangle(const TriangleSurface &surface);
    ~NearestTriangle();

    /// The distance to the surface, and the triangle that is nearest.
    std::pair<double, unsigned int>
    operator()(const SurfaceMesh::Vertex &place) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree;
  };

  /// Distances of a surface, sampled at its vertices and at the middles of its edges and triangles,
  /// to another one.
  struct SurfaceDistance
  {
    double maximum = 0.;
    double mean    = 0.; ///< weighted by area
  };

  SurfaceDistance
  distance_to(const NearestTriangle &to, const TriangleSurface &from);

  /// The smallest shell around each shell, or the number of shells for those within none.
  /// Precondition: shells are closed and do not intersect.
  std::vector<unsigned int>
  enclosing_shells(const TriangleSurface           &surface,
                   const std::vector<unsigned int> &shells,
                   unsigned int                     n_shells);

  /// Each triangle gets the group of the triangle of `from` that is nearest to its middle.
  void
  take_nearest_groups(TriangleSurface &surface, const TriangleSurface &from);
} // namespace Exemplar

#endif
