// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/cgal_surface.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/surface_repair.h>

#include <CGAL/alpha_wrap_3.h>

namespace Exemplar
{
  TriangleSurface
  wrap(const TriangleSurface &surface, const double openings)
  {
    CgalPoints   points;
    CgalPolygons polygons;
    to_soup(surface, points, polygons);
    const double alpha = openings * diagonal_of(surface.vertices);
    CgalMesh     mesh;
    CGAL::alpha_wrap_3(points, polygons, alpha, wrap_distance * alpha, mesh);
    TriangleSurface wrapped = from_cgal_mesh(mesh, [](const CgalMesh::Face_index) { return 0U; });
    take_nearest_groups(wrapped, surface);
    return wrapped;
  }
} // namespace Exemplar
