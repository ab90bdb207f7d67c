// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_surface_h
#define exemplar_contact_surface_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// Derivatives of a function by the shares of a ContactSurface [1/N], by its areas where shares stay, and by the squares
  /// of its edges' lengths at rest.
  struct ShareDerivatives
  {
    std::vector<double> triangles, edges, nodes, squares;
    std::vector<double> areas_of_triangles, areas_of_edges, areas_of_nodes;
  };

  /// What of the body meets obstacles: the flat triangles of its boundary (four of the six nodes of a quadratic face),
  /// their edges and nodes, each with its share of E A [N], the sum of Young's modulus times area at rest: a third of
  /// those of its triangles at a node and an edge. Of several processes each has its own faces, and edges and nodes
  /// between them in all with the shares of their own faces, so that sums over processes are those of the body.
  /// All triangles of a shell meet obstacles, on both sides, and the body begins half of their thickness from them.
  class ContactSurface
  {
  public:
    ContactSurface(const Mesh &mesh, const FESpace &fe_space);

    /// Take the shares of this material.
    void
    set_material(const Material &material);

    /// Whether the triangles bound a solid, so that no obstacle may be on their inner side.
    bool
    has_inside() const
    {
      return bounds_solid;
    }

    /// Greatest of the offsets [m].
    double
    greatest_offset() const
    {
      return greatest;
    }

    /// Zeros of the right sizes.
    ShareDerivatives
    no_derivatives() const;

    /// Chain rule: add the derivatives of a function of shares, areas and squares by Young's modulus of the cells and by the
    /// rest positions of the nodes, by degree of freedom, of which those in the middles of edges are numbers of their own.
    void
    carry(const ShareDerivatives &by_shares,
          const Material         &material,
          const FESpace          &fe_space,
          std::vector<double>    &by_young,
          dealii::Vector<double> &by_rest_positions) const;

    /// A flat triangle of the body's surface.
    struct Triangle
    {
      std::array<unsigned int, 3> nodes; ///< outwards, counterclockwise
      unsigned int                cell;
      double                      area;        ///< at rest [m^2]
      double                      offset = 0.; ///< how far it is below what obstacles meet [m]
      double                      share  = 0.; ///< [N]
    };

    /// An edge between two triangles of the surface.
    struct Edge
    {
      std::array<unsigned int, 2> nodes;       ///< ascending
      double                      square;      ///< of its length at rest [m^2]
      double                      area   = 0.; ///< a third of its triangles at rest [m^2]
      double                      offset = 0.; ///< greatest one of its triangles [m]
      double                      share  = 0.; ///< [N]
    };

    /// A node of the surface.
    struct Node
    {
      unsigned int node;
      double       area   = 0.; ///< at rest [m^2]
      double       offset = 0.; ///< greatest one of its triangles [m]
      double       share  = 0.; ///< [N]
    };

    std::vector<Triangle> triangles;
    std::vector<Edge>     edges; ///< ascending
    std::vector<Node>     nodes; ///< ascending

    /// The number of the edge between two nodes.
    unsigned int
    number_of_edge(unsigned int node, unsigned int other) const;

    /// The number of a node of the surface.
    unsigned int
    number_of_node(unsigned int node) const;

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      return triangles.size() * sizeof(Triangle) + edges.size() * sizeof(Edge)
             + nodes.size() * sizeof(Node);
    }

  private:
    void
    add_faces(const Mesh &mesh, const FESpace &fe_space);

    void
    add_shell(const ShellMesh &shell);

    /// Find edges and nodes with what they have of the triangles at rest.
    void
    find_edges_and_nodes(const FESpace &fe_space);

    bool   bounds_solid;
    double greatest = 0.; ///< of the offsets [m]
  };
} // namespace Exemplar

#endif
