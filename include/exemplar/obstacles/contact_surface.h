// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_surface_h
#define exemplar_contact_surface_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// What of the body meets obstacles: the flat triangles of its boundary (four of the six nodes of a quadratic face),
  /// their edges and nodes, each with its share of E A [N], the sum of Young's modulus times area at rest: a third of
  /// those of its triangles at a node and an edge. Of several processes each has its own faces, and edges and nodes
  /// between them in all with the shares of their own faces, so that sums over processes are those of the body.
  class ContactSurface
  {
  public:
    ContactSurface(const Mesh &mesh, const FESpace &fe_space);

    /// Take the shares of this material.
    void
    set_material(const Material &material);

    /// A flat triangle of the body's surface.
    struct Triangle
    {
      std::array<unsigned int, 3> nodes; ///< outwards, counterclockwise
      unsigned int                cell;
      double                      area;       ///< at rest [m^2]
      double                      share = 0.; ///< [N]
    };

    /// An edge between two triangles of the surface.
    struct Edge
    {
      std::array<unsigned int, 2> nodes;      ///< ascending
      double                      square;     ///< of its length at rest [m^2]
      double                      share = 0.; ///< [N]
    };

    /// A node of the surface.
    struct Node
    {
      unsigned int node;
      double       area  = 0.; ///< at rest [m^2]
      double       share = 0.; ///< [N]
    };

    std::vector<Triangle> triangles;
    std::vector<Edge>     edges; ///< ascending
    std::vector<Node>     nodes; ///< ascending

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      return triangles.size() * sizeof(Triangle) + edges.size() * sizeof(Edge)
             + nodes.size() * sizeof(Node);
    }
  };
} // namespace Exemplar

#endif
