// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_anchors_h
#define exemplar_surface_anchors_h

#include <exemplar/surface/shape/surface_mesh.h>

#include <deal.II/base/point.h>

namespace Exemplar
{
  class Mesh;

  /// The point of a body at rest to which a vertex of its surface belongs.
  struct SurfaceAnchor
  {
    std::array<unsigned int, 4> nodes;  ///< of its cell; on a boundary face three and one again
    std::array<double, 4>       shares; ///< of the nodes; they sum to 1
    dealii::Point<3>            place;  ///< [m]; that of the vertex, where it is inside
  };

  /// The anchors of all vertices [m] of a surface: a vertex inside is where it is, one outside at the
  /// nearest point of the mesh's boundary. The nearest point may be of another limb that comes close;
  /// then the boundary faces the other way than the surface does at the vertex, and the nearest
  /// point of those faces is taken that face the same way, if it is no farther than they are long.
  /// For vertices inside a cell, too, if there is a gap between them and that point.
  /// Where sheets overlap at rest, a vertex of one inside of cells of the other goes with its own: that of
  /// its nearest boundary, and of its neighbours on the surface (put_on_own_sheets()).
  std::vector<SurfaceAnchor>
  find_anchors(const SurfaceMesh &surface, const Mesh &mesh);

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
