// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_node_numbering_h
#define exemplar_node_numbering_h

#include <exemplar/kernels/element.h>
#include <exemplar/mesh/mesh.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/point.h>

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Throws UserError, calling the places `key`, unless the places behind those of the vertices are
  /// the middles of the edges, to 1e-9 of `size`.
  void
  check_straight(const std::vector<dealii::Point<3>>            &places,
                 const std::vector<std::array<unsigned int, 2>> &edges,
                 double                                          size,
                 const std::string                              &key);

  /// The nodes of a finite element on a mesh: the vertices, which are the nodes of the mesh file,
  /// followed by one in the middle of each edge for quadratic elements, in ascending order of the
  /// edges' ends, the lesser one first. Behind the vertices of a shell that has slopes there is one for the slope of the normal at
  /// each edge, in the same order; it belongs to no cell. A slope that is free has one degree of freedom, the component x,
  /// which is the turn of the normal out of the bisector times the edge's length [m]; y and z are 0 and held. A slope that
  /// is held has three, the place of the normal's tip, as far from the middle of the edge as that is long.
  class NodeNumbering
  {
  public:
    NodeNumbering(const Mesh &mesh, Element element, bool has_slopes = false);

    NodeNumbering(const NodeNumbering &) = delete; ///< it refers to itself

    unsigned int
    n_nodes() const
    {
      return mesh.n_nodes() + edges.size();
    }

    unsigned int
    n_vertices() const
    {
      return mesh.n_nodes();
    }

    /// Whether the nodes behind the vertices are slopes.
    bool
    has_slopes() const
    {
      return mesh.is_shell() && !edges.empty();
    }

    /// How many of the first nodes are places in space: all but slopes.
    unsigned int
    n_places() const
    {
      return has_slopes() ? n_vertices() : n_nodes();
    }

    /// The components of slopes that are never free, as degrees of freedom.
    std::vector<unsigned int>
    fixed_dofs() const;

    /// The edges with a node, by their ends.
    const std::vector<std::array<unsigned int, 2>> &
    get_edges() const
    {
      return edges;
    }

    /// Nodes of a cell: its vertices and then the middles of its edges 01, 12, 20, 03, 13, 23,
    /// which is the order of deal.II and of VTK.
    dealii::ArrayView<const unsigned int>
    of_cell(const unsigned int cell) const
    {
      return { nodes_of_cells + n_per_cell * cell, n_per_cell };
    }

    /// Nodes of a face: its vertices and then the middles of its edges 01, 12, 20.
    std::vector<unsigned int>
    of_face(const BoundaryFace &face) const;

    /// The ends of the edge whose middle is `node`.
    const std::array<unsigned int, 2> &
    ends(const unsigned int node) const
    {
      return edges[node - mesh.n_nodes()];
    }

    /// The piece of the mesh that each node belongs to, Mesh::piece_of().
    std::vector<unsigned int>
    pieces() const;

    /// `vertices` and the nodes on edges between two of them, in ascending order.
    std::vector<unsigned int>
    with_middles(std::vector<unsigned int> vertices) const;

    /// The places of all nodes, from those of the vertices alone, with the middles of the edges, or
    /// from those of all nodes. Throws UserError, calling the places `key`, for curved edges, which
    /// linear elements have not.
    std::vector<dealii::Point<3>>
    complete(std::vector<dealii::Point<3>> places, const std::string &key) const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    unsigned int
    middle_of(unsigned int a, unsigned int b) const;

    const Mesh                              &mesh;
    const std::size_t                        n_per_cell;
    std::vector<std::array<unsigned int, 2>> edges;          ///< edges with a node; empty: linear
    std::vector<unsigned int>                with_edges;     ///< nodes of each cell; empty: linear
    const unsigned int                      *nodes_of_cells; ///< data of with_edges, or of the mesh
  };
} // namespace Exemplar

#endif
