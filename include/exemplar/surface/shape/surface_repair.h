// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_repair_h
#define exemplar_surface_repair_h

#include <exemplar/surface/shape/triangle_surface.h>

namespace Exemplar
{
  /// A repaired surface, and the repairs that were made, a line each.
  struct RepairedSurface
  {
    TriangleSurface          surface;
    std::vector<std::string> done;
  };

  /// Join vertices at one place, turn faces to the majority, part what touches, stitch open edges,
  /// remove faces without area, fill holes and remove intersections, by CGAL; turn shells
  /// outwards and drop loose parts of less than 1 % of the largest volume. New triangles have the
  /// group of the nearest old one. The result may still be bad: check it.
  RepairedSurface
  repair(const TriangleSurface &surface);

  /// Offset of a wrap from the surface, over the size of the openings that it closes.
  constexpr double wrap_distance = .05;

  /// A closed surface around any triangles (Portaneri et al. 2022, alpha wrapping, by CGAL):
  /// openings of less than `openings` times the diagonal are closed, and its offset is
  /// wrap_distance times that size.
  TriangleSurface
  wrap(const TriangleSurface &surface, double openings);
} // namespace Exemplar

#endif
