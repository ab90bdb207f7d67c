// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/body_pair_search.h>
#include <exemplar/run/problem/standing_surface.h>

#include <algorithm>
#include <array>

namespace Exemplar
{
  std::vector<StandingSurface::Near>
  StandingSurface::near_pairs() const
  {
    KeptBodyPairs        none;
    const BodyPairSearch search(surface, contacts, none);
    const Places         places = search.places_of(positions);
    std::vector<Near>    result;
    for (const auto &candidate : search.search(places, places, contacts.width))
    {
      const BodyPairCorners at       = search.corners(candidate.pair, places);
      const double          distance = search.distance(candidate.pair, at.places).distance;
      if (distance < contacts.usual_width(contacts.pieces_of(surface, candidate.pair)))
        result.push_back({ candidate.pair, distance, at.places[3] });
    }
    return result;
  }

  std::vector<StandingSurface::Near>
  StandingSurface::crossing_pairs() const
  {
    std::vector<AxisBox> boxes;
    for (const ContactSurface::Triangle &triangle : surface.triangles)
      boxes.push_back(box_of(triangle.nodes));
    const BoxTree     tree(boxes);
    std::vector<Near> result;
    for (unsigned int e = 0; e < surface.edges.size(); ++e)
    {
      const auto                &ends = surface.edges[e].nodes;
      const std::array<Place, 2> edge{ { x(ends[0]), x(ends[1]) } };
      tree.visit(box_of(ends),
                 [&](const unsigned int t)
                 {
                   const auto &corners = surface.triangles[t].nodes;
                   // at a common node rounding alone would say on which side the edge begins
                   if (!have_a_common_node(ends, corners)
                       && passes_through(edge, { { x(corners[0]), x(corners[1]), x(corners[2]) } }))
                     add_crossing(e, t, result);
                 });
    }
    return result;
  }

  void
  StandingSurface::add_crossing(const unsigned int edge,
                                const unsigned int triangle,
                                std::vector<Near> &to) const
  {
    const Place place = x(surface.edges[edge].nodes[0]);
    const auto  add   = [&](const BodyPair &pair)
    {
      if (contacts.may_meet(surface, pair))
        to.push_back({ pair, 0., place });
    };
    for (const unsigned int node : surface.edges[edge].nodes)
      add({ BodyPairKind::node_triangle, surface.number_of_node(node), triangle });
    const auto &corners = surface.triangles[triangle].nodes;
    for (unsigned int k = 0; k < 3; ++k)
    {
      const unsigned int side = surface.number_of_edge(corners[k], corners[(k + 1) % 3]);
      add({ BodyPairKind::edge_edge, std::min(edge, side), std::max(edge, side) });
    }
  }
} // namespace Exemplar
