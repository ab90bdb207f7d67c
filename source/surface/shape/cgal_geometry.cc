// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/cgal_search.h>
#include <exemplar/surface/shape/cgal_surface.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/vectors.h>

#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>

#include <cmath>

namespace Exemplar
{
  std::vector<std::pair<unsigned int, unsigned int>>
  self_intersections(const TriangleSurface &surface)
  {
    const CgalMesh mesh = make_cgal_mesh(surface);
    using Face          = CgalMesh::Face_index;
    std::vector<std::pair<Face, Face>> found;
    CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(found));
    std::vector<std::pair<unsigned int, unsigned int>> pairs;
    for (const auto &[a, b] : found)
      pairs.emplace_back(std::min<unsigned int>(a, b), std::max<unsigned int>(a, b));
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }

  struct NearestTriangle::Tree
  {
    using Triangles = std::vector<CgalKernel::Triangle_3>;
    using Search    = TriangleSearch<CgalKernel, Triangles::const_iterator>;

    Triangles triangles;
    Search    search;
  };

  NearestTriangle::NearestTriangle(const TriangleSurface &surface) : tree(std::make_unique<Tree>())
  {
    for (const auto &t : surface.triangles)
      tree->triangles.emplace_back(to_cgal(surface.vertices[t[0]]), to_cgal(surface.vertices[t[1]]),
                                   to_cgal(surface.vertices[t[2]]));
    tree->search.insert(tree->triangles.cbegin(), tree->triangles.cend());
    tree->search.build();
    tree->search.accelerate_distance_queries();
  }

  NearestTriangle::~NearestTriangle() = default;

  std::pair<double, unsigned int>
  NearestTriangle::operator()(const SurfaceMesh::Vertex &place) const
  {
    const auto [point, triangle] = tree->search.closest_point_and_primitive(to_cgal(place));
    return { norm(minus(place, from_cgal(point))),
             static_cast<unsigned int>(triangle - tree->triangles.cbegin()) };
  }

  SurfaceDistance
  distance_to(const NearestTriangle &to, const TriangleSurface &from)
  {
    SurfaceDistance distance;
    double          area = 0.;
    for (std::size_t t = 0; t < from.triangles.size(); ++t)
    {
      const auto       &corners = from.triangles[t];
      const SpaceVector origin{ { 0., 0., 0. } };
      const auto        at = [&](const double a, const double b, const double c)
      {
        const double d = to(plus(plus(plus(origin, a, from.vertices[corners[0]]), b,
                                      from.vertices[corners[1]]),
                                 c, from.vertices[corners[2]]))
                             .first;
        distance.maximum = std::max(distance.maximum, d);
        return d;
      };
      const double corner_sum = at(1, 0, 0) + at(0, 1, 0) + at(0, 0, 1);
      const double side_sum   = at(.5, .5, 0) + at(0, .5, .5) + at(.5, 0, .5);
      const double middle     = at(1. / 3, 1. / 3, 1. / 3);
      // exact for cubic functions on a triangle (Stroud 1971, T2:3-3)
      distance.mean += area_of(from, t) * (3. * corner_sum + 8. * side_sum + 27. * middle) / 60.;
      area += area_of(from, t);
    }
    distance.mean /= area;
    return distance;
  }

  std::vector<unsigned int>
  enclosing_shells(const TriangleSurface           &surface,
                   const std::vector<unsigned int> &shells,
                   const unsigned int               n_shells)
  {
    std::vector<unsigned int> around(n_shells, n_shells);
    if (n_shells < 2)
      return around;
    std::vector<double>              smallest(n_shells, 0.);
    std::vector<SurfaceMesh::Vertex> a_vertex(n_shells);
    for (std::size_t t = 0; t < shells.size(); ++t)
      a_vertex[shells[t]] = surface.vertices[surface.triangles[t][0]];
    for (unsigned int outer = 0; outer < n_shells; ++outer)
    {
      const TriangleSurface shell  = shell_of(surface, shells, outer);
      const double          volume = std::abs(enclosed_volume(shell));
      const CgalMesh        mesh   = make_cgal_mesh(shell);
      const CGAL::Side_of_triangle_mesh<CgalMesh, CgalKernel> side_of(mesh);
      for (unsigned int inner = 0; inner < n_shells; ++inner)
        if (inner != outer && side_of(to_cgal(a_vertex[inner])) == CGAL::ON_BOUNDED_SIDE
            && (around[inner] == n_shells || volume < smallest[inner]))
        {
          around[inner]   = outer;
          smallest[inner] = volume;
        }
    }
    return around;
  }

  void
  take_nearest_groups(TriangleSurface &surface, const TriangleSurface &from)
  {
    const NearestTriangle nearest(from);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    {
      SurfaceMesh::Vertex middle{ { 0., 0., 0. } };
      for (const unsigned int vertex : surface.triangles[t])
        for (unsigned int d = 0; d < 3; ++d)
          middle[d] += surface.vertices[vertex][d] / 3.;
      surface.groups[t] = from.groups[nearest(middle).second];
    }
  }
} // namespace Exemplar
