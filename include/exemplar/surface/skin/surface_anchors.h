// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_anchors_h
#define exemplar_surface_anchors_h

#include <exemplar/mesh/msh_file.h>
#include <exemplar/surface/shape/surface_mesh.h>

#include <deal.II/base/point.h>

namespace Exemplar
{
  class Mesh;

  /// The point of a body at rest to which a vertex of its surface belongs.
  struct SurfaceAnchor
  {
    std::array<unsigned int, 4> nodes;  ///< nodes of the cell; of a face three and one again
    std::array<double, 4>       shares; ///< barycentric coordinates, sum 1
    dealii::Point<3>            place;  ///< place at rest [m]; the vertex itself, if inside
  };

  /// The anchors of all vertices [m] of a surface: a vertex inside is its own anchor, one outside
  /// has the nearest point of the mesh's boundary. The nearest point may be of another limb that
  /// comes close; then the boundary faces the other way than the surface does at the vertex, and
  /// the nearest point is sought on faces that face the same way, and taken if it is no farther
  /// than they are long. So it is for vertices inside a cell, too, if there is a gap between them
  /// and that point. Where sheets overlap at rest, a vertex of one sheet that lies inside cells of
  /// the other is anchored to its own sheet: that of its nearest boundary, and of its neighbours on
  /// the surface (put_on_own_sheets()).
  /// If the mesh has ties of a surface of as many vertices that lies where this one does, the anchors
  /// are these ties (make_ties()).
  std::vector<SurfaceAnchor>
  find_anchors(const SurfaceMesh &surface, const Mesh &mesh);

  /// The anchors of a surface where it was filled, for the record of the mesh that comes of it: where
  /// sheets that overlap at rest are apart, each vertex is nearest to its own.
  std::vector<SurfaceTie>
  make_ties(const SurfaceMesh &surface, const Mesh &mesh);

  /// Throws UserError unless the surface [m] may be that of the mesh: no vertex of its faces is far
  /// outside, and the mesh's boundary is not far from it. Lengths in the message are in the unit
  /// of the files, of which `scale` makes metres.
  void
  check_anchors(const SurfaceMesh                &surface,
                const std::vector<SurfaceAnchor> &anchors,
                const Mesh                       &mesh,
                double                            scale,
                const std::string                &surface_name);
} // namespace Exemplar

#endif
