// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/surface_pairs.h>

#include <array>
#include <utility>

namespace Exemplar
{
  namespace
  {
    template <typename Nodes>
    AxisBox
    box_on_way(const Nodes                             &nodes,
               const std::vector<dealii::Tensor<1, 3>> &places,
               const std::vector<dealii::Tensor<1, 3>> &ends)
    {
      AxisBox box;
      for (const unsigned int node : nodes)
      {
        box.add(places[node]);
        box.add(ends[node]);
      }
      return box;
    }

    std::vector<AxisBox>
    chosen(const std::vector<AxisBox> &boxes, const std::vector<unsigned int> &numbers)
    {
      std::vector<AxisBox> result;
      result.reserve(numbers.size());
      for (const unsigned int i : numbers)
        result.push_back(boxes[i]);
      return result;
    }
  } // namespace

  SurfacePairs::SurfacePairs(const ContactSurface                    &surface,
                             const std::vector<unsigned int>         &pieces_of_nodes,
                             const std::vector<dealii::Tensor<1, 3>> &places)
      : surface(surface), parts(surface.triangles.size())
  {
    std::vector<char> has_triangle_of_edge(surface.edges.size(), 0),
        has_triangle_of_node(surface.nodes.size(), 0);
    for (unsigned int t = 0; t < surface.triangles.size(); ++t)
    {
      const auto &nodes = surface.triangles[t].nodes;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const unsigned int node = surface.number_of_node(nodes[i]),
                           edge = surface.number_of_edge(nodes[i], nodes[(i + 1) % 3]);
        if (!std::exchange(has_triangle_of_node[node], 1))
          parts[t].nodes.push_back(node);
        if (!std::exchange(has_triangle_of_edge[edge], 1))
          parts[t].edges.push_back(edge);
      }
      const unsigned int piece = pieces_of_nodes[nodes[0]];
      if (piece >= pieces.size())
        pieces.resize(piece + 1);
      pieces[piece].triangles.push_back(t);
    }
    move(places, places, 0.);
    for (Piece &piece : pieces)
      piece.tree = BoxTree(chosen(boxes_of_triangles, piece.triangles));
  }

  void
  SurfacePairs::move(const std::vector<dealii::Tensor<1, 3>> &places,
                     const std::vector<dealii::Tensor<1, 3>> &ends,
                     const double                             reach)
  {
    const auto move_boxes = [&](const auto &of_parts, std::vector<AxisBox> &boxes)
    {
      boxes.clear();
      for (const auto &part : of_parts)
        boxes.push_back(box_on_way(part.nodes, places, ends).widened(0.5 * reach));
    };
    move_boxes(surface.triangles, boxes_of_triangles);
    move_boxes(surface.edges, boxes_of_edges);
    boxes_of_nodes.clear();
    for (const ContactSurface::Node &at : surface.nodes)
      boxes_of_nodes.push_back(box_on_way(std::array<unsigned int, 1>{ { at.node } }, places, ends)
                                   .widened(0.5 * reach));
    for (Piece &piece : pieces)
      if (!piece.tree.empty())
        piece.tree.move(chosen(boxes_of_triangles, piece.triangles));
  }

  std::size_t
  SurfacePairs::memory_consumption() const
  {
    // a tree has less than one node for two boxes
    const std::size_t of_triangle = sizeof(Parts) + 3 * sizeof(AxisBox) + 4 * sizeof(unsigned int);
    return parts.size() * of_triangle
           + (boxes_of_edges.size() + boxes_of_nodes.size()) * sizeof(AxisBox);
  }
} // namespace Exemplar
