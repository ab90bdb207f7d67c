// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_pairs_h
#define exemplar_surface_pairs_h

#include <exemplar/obstacles/body_contacts.h>
#include <exemplar/obstacles/box_tree.h>

#include <vector>

namespace Exemplar
{
  /// Finds which parts of a surface are near which others: each piece has a tree of boxes around its triangles, which is made once and
  /// moves with them. A node and an edge belong to one of their triangles, so that each pair is found with one pair of triangles.
  class SurfacePairs
  {
  public:
    /// The surface must outlive it, and each of its edges and nodes be of a triangle. `places` are those of the nodes, by which
    /// triangles are brought into an order: a matter of speed.
    SurfacePairs(const ContactSurface                    &surface,
                 const std::vector<unsigned int>         &pieces,
                 const std::vector<dealii::Tensor<1, 3>> &places);

    /// Let all parts have the boxes of their nodes on the way from `places` to `ends`, wider by half of `reach` [m] to all sides.
    void
    move(const std::vector<dealii::Tensor<1, 3>> &places,
         const std::vector<dealii::Tensor<1, 3>> &ends,
         double                                   reach);

    /// Call visit(pair) once for each pair of a node and a triangle or of two edges whose boxes meet, those of one piece only if
    /// `also_self`, in an order that the trees decide.
    template <typename Visit>
    void
    visit(bool also_self, const Visit &visit) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// What hangs together.
    struct Piece
    {
      std::vector<unsigned int> triangles;
      BoxTree                   tree; ///< of these
    };

    /// What belongs to a triangle, by number.
    struct Parts
    {
      std::vector<unsigned int> nodes, edges;
    };

    template <typename Visit>
    void
    visit_nodes(unsigned int of_triangle, unsigned int near_triangle, const Visit &visit) const;

    template <typename Visit>
    void
    visit_edges(unsigned int of_triangle, unsigned int near_triangle, const Visit &visit) const;

    const ContactSurface &surface;
    std::vector<Piece>    pieces;
    std::vector<Parts>    parts; ///< of the triangles
    std::vector<AxisBox>  boxes_of_triangles, boxes_of_edges, boxes_of_nodes;
  };

  template <typename Visit>
  void
  SurfacePairs::visit_nodes(const unsigned int of_triangle,
                            const unsigned int near_triangle,
                            const Visit       &visit) const
  {
    for (const unsigned int node : parts[of_triangle].nodes)
      if (boxes_of_nodes[node].meets(boxes_of_triangles[near_triangle]))
        visit(BodyPair{ BodyPairKind::node_triangle, node, near_triangle });
  }

  template <typename Visit>
  void
  SurfacePairs::visit_edges(const unsigned int of_triangle,
                            const unsigned int near_triangle,
                            const Visit       &visit) const
  {
    for (const unsigned int edge : parts[of_triangle].edges)
      for (const unsigned int other : parts[near_triangle].edges)
        if (boxes_of_edges[edge].meets(boxes_of_edges[other]))
          visit(BodyPair{ BodyPairKind::edge_edge, std::min(edge, other), std::max(edge, other) });
  }

  template <typename Visit>
  void
  SurfacePairs::visit(const bool also_self, const Visit &visit) const
  {
    for (auto a = pieces.begin(); a != pieces.end(); ++a)
      for (auto b = also_self ? a : std::next(a); b != pieces.end(); ++b)
        a->tree.visit_pairs(b->tree,
                            [&](const unsigned int i, const unsigned int j)
                            {
                              const unsigned int t = a->triangles[i], u = b->triangles[j];
                              visit_nodes(t, u, visit);
                              visit_nodes(u, t, visit);
                              visit_edges(t, u, visit);
                            });
  }
} // namespace Exemplar

#endif
