// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/making/sheet_crossings.h>
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_geometry.h>

#include <algorithm>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    /// Faults that violate the preconditions of self_intersections().
    const std::vector<std::string> unsound
        = { "edges of more than two faces", "vertices where the surface touches itself",
            "faces turned against their neighbours", "one-sided" };

    std::vector<bool>
    unsound_triangles(const TriangleSurface &surface)
    {
      std::vector<bool> triangles(surface.triangles.size(), false);
      std::vector<bool> vertices(surface.vertices.size(), false);
      for (const FaultyElement &element : check_surface({ surface, {} }).elements)
        if (std::find(unsound.begin(), unsound.end(), element.fault) != unsound.end())
          (element.is_face ? triangles : vertices)[element.index] = true;
      for (std::size_t t = 0; t < triangles.size(); ++t)
        for (const unsigned int vertex : surface.triangles[t])
          triangles[t] = triangles[t] || vertices[vertex];
      return triangles;
    }
  } // namespace

  SheetCrossings::SheetCrossings(const TriangleSurface &surface)
      : sound(surface), numbers(surface.triangles.size())
  {
    std::iota(numbers.begin(), numbers.end(), 0U);
    for (std::vector<bool> bad                                     = unsound_triangles(sound);
         std::find(bad.begin(), bad.end(), true) != bad.end(); bad = unsound_triangles(sound))
    {
      std::size_t n = 0;
      for (std::size_t t = 0; t < bad.size(); ++t)
        if (!bad[t])
        {
          sound.triangles[n] = sound.triangles[t];
          sound.groups[n]    = sound.groups[t];
          numbers[n++]       = numbers[t];
        }
      sound.triangles.resize(n);
      sound.groups.resize(n);
      numbers.resize(n);
    }
  }

  std::vector<std::pair<unsigned int, unsigned int>>
  SheetCrossings::pairs(const std::vector<SurfaceMesh::Vertex> &vertices) const
  {
    TriangleSurface placed = sound;
    placed.vertices        = vertices;
    auto found             = self_intersections(placed);
    for (auto &[a, b] : found)
    {
      a = numbers[a];
      b = numbers[b];
    }
    return found;
  }

  bool
  has_crossing_sheets(const SurfaceMesh &surface)
  {
    return !SheetCrossings(triangulate(surface)).pairs(surface.vertices).empty();
  }
} // namespace Exemplar
