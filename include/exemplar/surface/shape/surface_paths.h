// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_paths_h
#define exemplar_surface_paths_h

#include <exemplar/surface/shape/closest_points.h>

namespace Exemplar
{
  /// Distances along a surface of triangles, which may have holes, edges of more than two
  /// triangles and vertices of the same place. Paths go from point to point of the triangles'
  /// edges, corners and eight points in between, straight through the triangles (Lanthier,
  /// Maheshwari, Sack 1997: Approximating weighted shortest paths on polyhedral surfaces), so that
  /// they are never shorter than the shortest ones, and 1 % longer at most where triangles are not
  /// stretched. CGAL's exact paths take far longer and need manifolds.
  class SurfacePaths
  {
  public:
    /// Distances from the nearest of the `sources`, which are vertices; none greater than `limit`
    /// is searched for.
    SurfacePaths(const TriangleSurface           &surface,
                 const std::vector<unsigned int> &sources,
                 double                           limit);

    /// The distance of a point from the sources; infinite if there is no path within the limit.
    double
    distance(const SurfacePoint &point) const;

  private:
    static constexpr unsigned int n_between = 8; ///< points on each edge

    void
    number_points(const std::vector<unsigned int> &sources);
    unsigned int
    point_on_edge(unsigned int a, unsigned int b, unsigned int k) const;
    SurfaceMesh::Vertex
    place(unsigned int point) const;
    void
    search();

    static constexpr unsigned int n_around = 3 + 3 * n_between; ///< points around a triangle

    const TriangleSurface                          &surface;
    const double                                    limit;
    std::vector<unsigned int>                       same;   ///< first vertex at each vertex's place
    std::vector<std::array<unsigned int, 2>>        edges;  ///< sorted
    std::vector<std::array<unsigned int, n_around>> around; ///< points around each triangle
    std::vector<double>                             distances; ///< distance of each point
  };
} // namespace Exemplar

#endif
