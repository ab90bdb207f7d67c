// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_remeshing_h
#define exemplar_surface_remeshing_h

#include <exemplar/surface/shape/triangle_surface.h>

namespace Exemplar
{
  /// A closed, oriented manifold surface with edges of about `edge_length`, its vertices on the
  /// surface given (isotropic remeshing, Botsch and Kobbelt 2004, by CGAL). The borders of groups
  /// stay where they are; with `keep_edges` so do edges sharper than 60 degrees, where they make
  /// chains of several times the edge length: short ones are noise. The triangles that are `held`
  /// stay as they are, but for vertices on edges that they share with others; none: all may change.
  TriangleSurface
  remesh(const TriangleSurface   &surface,
         double                   edge_length,
         bool                     keep_edges,
         const std::vector<bool> &held = {});

  /// Treatment of sheets that almost touch, as the lips of a mouth do, and that intersect when each
  /// is remeshed by itself.
  enum class NearSheets
  {
    held,   ///< their triangles stay as they are, so that the number of triangles hardly changes
    refined ///< all edges become shorter, so that triangles there are better
  };

  /// A remeshed surface.
  struct Remeshed
  {
    TriangleSurface surface;
    bool            has_near_sheets; ///< whether the first remeshing intersected itself
  };

  /// remesh() that keeps the order of the shells and leaves no intersections: where there are some,
  /// `near_sheets` is tried first and then the other treatment. Throws SolverFailure if neither
  /// helps; `cells_option` is the option by which the user asks for more cells.
  Remeshed
  remesh_without_intersections(const TriangleSurface &surface,
                               double                 edge_length,
                               bool                   keep_edges,
                               NearSheets             near_sheets,
                               const std::string     &cells_option);
} // namespace Exemplar

#endif
