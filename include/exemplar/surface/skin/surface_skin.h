// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_skin_h
#define exemplar_surface_skin_h

#include <exemplar/algebra/vector.h>
#include <exemplar/surface/shape/surface_mesh.h>
#include <exemplar/surface/skin/motion_recovery.h>

#include <deal.II/base/point.h>

namespace Exemplar
{
  /// A surface that the body carries along. A vertex at X with the anchor P in the body (X itself,
  /// inside; see find_anchors()) is displaced by
  ///
  ///   u = sum_a N_a(P) (u_a + 1/2 G_a (P - X_a) + G_a (X - P) + 1/2 (X - P) H_a (X - P))
  ///
  /// over the nodes a of the cell or face of P, with first and second derivatives G_a and H_a of
  /// the displacement that are recovered at the nodes. Quadratic motions are carried exactly, so
  /// that the cells' borders do not show as in sum_a N_a u_a; without displacement the vertices are
  /// at their rest places, to the last bit.
  class SurfaceSkin
  {
  public:
    /// Attaches a surface, in the unit of the mesh's file; that of a shell is the shell itself. If `surface_name`, for messages, is not
    /// empty, the surface is checked: UserError if it is not that of the mesh.
    SurfaceSkin(const SurfaceMesh &surface, const Mesh &mesh, const std::string &surface_name = "");

    /// The places of the vertices in the unit of the mesh's file, in the file's order, where the
    /// nodes are displaced [m] by three values each.
    std::vector<SurfaceMesh::Vertex>
    carry(const Vector &displacement) const;

    /// Nodes and coefficients of a vertex: its displacement is the sum of theirs times these.
    std::vector<NodalSum::Share>
    shares_of(std::size_t vertex) const;

    /// Place of a vertex at rest [m].
    dealii::Point<3>
    place_at_rest(std::size_t vertex) const;

  private:
    friend SurfaceSkin
    skin_of_carried(const SurfaceMesh &surface, const Mesh &mesh, const std::string &name);

    SurfaceSkin(const SurfaceMesh &surface, double scale) : rest(surface.vertices), scale(scale) {}

    std::vector<SurfaceMesh::Vertex> rest;
    double                           scale;  ///< metres per unit of the file
    std::vector<NodalSum::Share>     shares; ///< coefficients of all vertices, one after the other
    std::vector<std::size_t>         ends;   ///< end of each vertex's part of `shares`
  };

  /// A surface that is inside, on or outside of the body and goes along with it: a vertex at X is
  /// displaced by
  ///
  ///   u(X) = sum_a phi_a(X) (u_a + G_a (X - X_a) + 1/2 (X - X_a) H_a (X - X_a))
  ///
  /// over the nodes near to it, with derivatives that are recovered at the nodes. phi is smooth and
  /// spreads over a few cells near the body, and farther outside as far as the vertex is from it. u
  /// depends on the place X at rest alone, and smoothly: sheets that touch stay together, and none
  /// tears between two limbs. Affine motions are carried exactly. UserError, which begins with the
  /// name, for a surface that is farther from the body than that is large.
  SurfaceSkin
  skin_of_carried(const SurfaceMesh &surface, const Mesh &mesh, const std::string &name);
} // namespace Exemplar

#endif
