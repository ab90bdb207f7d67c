// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/cgal_search.h>
#include <exemplar/surface/shape/cgal_surface.h>
#include <exemplar/surface/shape/narrow_gaps.h>
#include <exemplar/surface/shape/vectors.h>

#include <CGAL/Side_of_triangle_mesh.h>

namespace Exemplar
{
  namespace
  {
    using Triangles = std::vector<CgalKernel::Triangle_3>;
    using Search    = TriangleSearch<CgalKernel, Triangles::const_iterator>;

    /// Gaps narrower than this share of the greatest width are left to the search for
    /// intersections: their middle is on both sheets to rounding.
    constexpr double least_share = 1e-4;

    /// The point of a triangle at a place in its plane.
    SurfacePoint
    point_in(const TriangleSurface &surface, const unsigned int triangle, const SpaceVector &place)
    {
      const auto       &t      = surface.triangles[triangle];
      const auto       &x      = surface.vertices;
      const SpaceVector normal = cross(minus(x[t[1]], x[t[0]]), minus(x[t[2]], x[t[0]]));
      SurfacePoint      point{ triangle, {} };
      for (int a = 0; a < 3; ++a)
        point.share[a]
            = dot(cross(minus(x[t[(a + 1) % 3]], place), minus(x[t[(a + 2) % 3]], place)), normal)
              / dot(normal, normal);
      return point;
    }

    SpaceVector
    weighted(const TriangleSurface &surface, const SurfacePoint &point)
    {
      SpaceVector place{ { 0., 0., 0. } };
      for (int a = 0; a < 3; ++a)
        place = plus(place, point.share[a], surface.vertices[surface.triangles[point.triangle][a]]);
      return place;
    }
  } // namespace

  std::vector<NarrowGap>
  narrow_gaps(const TriangleSurface &surface, const double width)
  {
    Triangles triangles;
    for (const auto &t : surface.triangles)
      triangles.emplace_back(to_cgal(surface.vertices[t[0]]), to_cgal(surface.vertices[t[1]]),
                             to_cgal(surface.vertices[t[2]]));
    Search search(triangles.cbegin(), triangles.cend());
    search.build();
    std::vector<NarrowGap> gaps;
    for (unsigned int t = 0; t < triangles.size(); ++t)
    {
      const auto       &corner = surface.triangles[t];
      const SpaceVector a      = surface.vertices[corner[0]];
      const SpaceVector normal
          = cross(minus(surface.vertices[corner[1]], a), minus(surface.vertices[corner[2]], a));
      const double length = norm(normal);
      if (!(length > 0.))
        continue;
      const SurfacePoint                     near{ t, { { 1. / 3., 1. / 3., 1. / 3. } } };
      const SpaceVector                      place = weighted(surface, near);
      const SpaceVector                      far   = plus(place, width / length, normal);
      const CgalKernel::Segment_3            way(to_cgal(place), to_cgal(far));
      double                                 nearest = 1.;
      unsigned int                           other   = t;
      std::vector<Triangles::const_iterator> met;
      search.all_intersected_primitives(way, std::back_inserter(met));
      for (const auto &triangle : met)
      {
        const auto n = static_cast<unsigned int>(triangle - triangles.cbegin());
        if (n == t)
          continue;
        const auto   plane = triangle->supporting_plane();
        const auto   along = plane.orthogonal_vector();
        const double down  = along * (way.target() - way.source());
        if (!(down < 0.))
          continue; // it faces the same way
        const double share = (along * ((*triangle)[0] - way.source())) / down;
        if (share > least_share && share < nearest)
        {
          nearest = share;
          other   = n;
        }
      }
      if (other == t)
        continue;
      const SpaceVector hit = plus(place, nearest * width / length, normal);
      gaps.push_back({ near, point_in(surface, other, hit), plus(place, .5, minus(hit, place)) });
    }
    return gaps;
  }

  std::vector<bool>
  are_outside(const TriangleSurface &surface, const std::vector<SpaceVector> &places)
  {
    const CgalMesh                                          mesh = make_cgal_mesh(surface);
    const CGAL::Side_of_triangle_mesh<CgalMesh, CgalKernel> side_of(mesh);
    std::vector<bool>                                       result;
    for (const SpaceVector &place : places)
      result.push_back(side_of(to_cgal(place)) == CGAL::ON_UNBOUNDED_SIDE);
    return result;
  }
} // namespace Exemplar
