// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/triangle_surface.h>
#include <exemplar/surface/shape/vectors.h>

#include <algorithm>
#include <limits>

namespace Exemplar
{
  namespace
  {
    using Triangle = std::array<unsigned int, 3>;

    /// Cuts ears off one polygon.
    class EarCutter
    {
    public:
      EarCutter(const std::vector<SpaceVector> &places, const std::vector<unsigned int> &polygon)
          : vertices(places), rest(polygon), normal{ { 0., 0., 0. } }
      {
        for (std::size_t i = 0; i < rest.size(); ++i) // Newell's normal
          normal = plus(normal, 1.,
                        cross(minus(at(i), at(0)), minus(at((i + 1) % rest.size()), at(0))));
      }

      void
      cut_into(std::vector<Triangle> &triangles)
      {
        while (rest.size() > 3)
        {
          const std::size_t ear = best_ear();
          triangles.push_back(corner(ear));
          rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        triangles.push_back({ { rest[0], rest[1], rest[2] } });
      }

    private:
      const SpaceVector &
      at(const std::size_t i) const
      {
        return vertices[rest[i]];
      }

      /// The triangle of a corner and its neighbours.
      Triangle
      corner(const std::size_t i) const
      {
        const std::size_t n = rest.size();
        return { { rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n] } };
      }

      /// Twice the area seen along the normal, times the normal's length.
      double
      seen_area(const SpaceVector &a, const SpaceVector &b, const SpaceVector &c) const
      {
        return dot(normal, cross(minus(b, a), minus(c, a)));
      }

      bool
      holds_another_vertex(const Triangle &ear) const
      {
        const SpaceVector &a = vertices[ear[0]], &b = vertices[ear[1]], &c = vertices[ear[2]];
        return std::any_of(rest.begin(), rest.end(),
                           [&](const unsigned int v)
                           {
                             const SpaceVector &p = vertices[v];
                             return v != ear[0] && v != ear[1] && v != ear[2]
                                    && seen_area(a, b, p) >= 0. && seen_area(b, c, p) >= 0.
                                    && seen_area(c, a, p) >= 0.;
                           });
      }

      /// 1 for the equilateral triangle, 0 for flat ones, negative for those that are no ears.
      double
      quality(const Triangle &ear) const
      {
        const SpaceVector ab = minus(vertices[ear[1]], vertices[ear[0]]),
                          bc = minus(vertices[ear[2]], vertices[ear[1]]),
                          ca = minus(vertices[ear[0]], vertices[ear[2]]);
        const double area    = seen_area(vertices[ear[0]], vertices[ear[1]], vertices[ear[2]]);
        const double squares = norm(normal) * (dot(ab, ab) + dot(bc, bc) + dot(ca, ca));
        if (!(squares > 0.))
          return -1.;
        const double ratio = 2. * std::sqrt(3.) * area / squares;
        return ratio > 0. && holds_another_vertex(ear) ? ratio - 2. : ratio;
      }

      /// The corner of the ear with the best quality; for a quadrilateral, the worse of the two
      /// triangles of each cut counts.
      std::size_t
      best_ear() const
      {
        std::size_t best         = 0;
        double      best_quality = -std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < rest.size(); ++i)
        {
          double q = quality(corner(i));
          if (rest.size() == 4)
            q = std::min(q, quality(corner((i + 2) % 4)));
          if (q > best_quality)
          {
            best         = i;
            best_quality = q;
          }
        }
        return best;
      }

      const std::vector<SpaceVector> &vertices;
      std::vector<unsigned int>       rest;
      SpaceVector                     normal;
    };
  } // namespace

  TriangleSurface
  triangulate(const SurfaceMesh &surface, std::vector<unsigned int> *const faces)
  {
    TriangleSurface result{ surface.vertices, {}, {} };
    if (faces != nullptr)
      faces->clear();
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
    {
      EarCutter(surface.vertices, surface.faces[f]).cut_into(result.triangles);
      result.groups.resize(result.triangles.size(),
                           surface.face_groups.empty() ? 0 : surface.face_groups[f]);
      if (faces != nullptr)
        faces->resize(result.triangles.size(), static_cast<unsigned int>(f));
    }
    return result;
  }

  double
  enclosed_volume(const TriangleSurface &surface)
  {
    double volume = 0.;
    for (const Triangle &t : surface.triangles)
      volume += six_volumes(surface.vertices[0], surface.vertices[t[0]], surface.vertices[t[1]],
                            surface.vertices[t[2]])
                / 6.;
    return volume;
  }

  double
  diagonal_of(const std::vector<SurfaceMesh::Vertex> &vertices)
  {
    SpaceVector low = vertices.at(0), high = vertices.at(0);
    for (const SpaceVector &vertex : vertices)
      for (unsigned int d = 0; d < 3; ++d)
      {
        low[d]  = std::min(low[d], vertex[d]);
        high[d] = std::max(high[d], vertex[d]);
      }
    return norm(minus(high, low));
  }

  double
  area_of(const TriangleSurface &surface, const std::size_t triangle)
  {
    const Triangle &t = surface.triangles[triangle];
    return .5
           * norm(cross(minus(surface.vertices[t[1]], surface.vertices[t[0]]),
                        minus(surface.vertices[t[2]], surface.vertices[t[0]])));
  }
} // namespace Exemplar
