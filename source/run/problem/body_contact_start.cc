// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/potential/body_pair_search.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/run/problem/body_contact_start.h>

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace Exemplar
{
  namespace
  {
    /// Of the largest piece's diameter: what is nearer touches.
    constexpr double touching = 1e-9;

    /// Parts of a surface that are somewhere: the pairs that are near each other, and where it crosses itself.
    class StandingSurface
    {
    public:
      StandingSurface(const BodyContacts   &contacts,
                      const ContactSurface &surface,
                      const Vector         &positions)
          : contacts(contacts), surface(surface), positions(positions)
      {
      }

      /// A pair, its distance [m] and its place.
      struct Near
      {
        BodyPair     pair;
        double       distance;
        SpaceVector3 place;
      };

      std::vector<Near>
      near_pairs() const
      {
        KeptBodyPairs        none;
        const BodyPairSearch search(surface, contacts, none);
        const Places         places = search.places_of(positions);
        std::vector<Near>    result;
        for (const auto &candidate : search.search(places, places, contacts.width))
        {
          const BodyPairCorners x        = search.corners(candidate.pair, places);
          const double          distance = search.distance(candidate.pair, x.places).distance;
          if (distance < contacts.width)
            result.push_back({ candidate.pair, distance, x.places[3] });
        }
        return result;
      }

      /// The pairs of an edge that passes through a triangle with that: ends and triangle, edge and sides; by their keys, with a
      /// place.
      std::vector<Near>
      crossing_pairs() const
      {
        std::vector<AxisBox> boxes;
        for (const ContactSurface::Triangle &triangle : surface.triangles)
          boxes.push_back(box_of(triangle.nodes));
        const BoxTree     tree(boxes);
        std::vector<Near> result;
        for (unsigned int e = 0; e < surface.edges.size(); ++e)
        {
          const auto                       &ends = surface.edges[e].nodes;
          const std::array<SpaceVector3, 2> edge{ { x(ends[0]), x(ends[1]) } };
          tree.visit(
              box_of(ends),
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

    private:
      SpaceVector3
      x(const unsigned int node) const
      {
        return at_node(positions, node);
      }

      template <typename Nodes>
      AxisBox
      box_of(const Nodes &nodes) const
      {
        AxisBox box;
        for (const unsigned int node : nodes)
          box.add(x(node));
        return box;
      }

      void
      add_crossing(const unsigned int edge,
                   const unsigned int triangle,
                   std::vector<Near> &to) const
      {
        const SpaceVector3 place = x(surface.edges[edge].nodes[0]);
        const auto         add   = [&](const BodyPair &pair)
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

      const BodyContacts   &contacts;
      const ContactSurface &surface;
      const Vector         &positions;
    };

    /// What the header of a run says of the selections that never touch each other. Throws UserError for one without a node of the surface.
    std::string
    left_out_note(const BodyContacts &contacts, const ContactSurface &surface)
    {
      std::string text;
      for (std::size_t i = 0; i < contacts.left_out.size(); ++i)
      {
        const auto lies_in = [&](const auto &nodes)
        {
          return std::all_of(nodes.begin(), nodes.end(),
                             [&](const unsigned int node)
                             { return (contacts.selections_of(node) >> i & 1U) != 0; });
        };
        const auto n_nodes
            = std::count_if(surface.nodes.begin(), surface.nodes.end(),
                            [&](const ContactSurface::Node &at)
                            { return lies_in(std::array<unsigned int, 1>{ { at.node } }); });
        if (n_nodes == 0)
          throw UserError("Contact/Leave out: '" + contacts.left_out[i]
                          + "' has no node of the body's surface, which alone touches anything. "
                            "Enlarge or move the selection, or remove it.");
        const auto n_faces = std::count_if(surface.triangles.begin(), surface.triangles.end(),
                                           [&](const ContactSurface::Triangle &triangle)
                                           { return lies_in(triangle.nodes); });
        text += fmt::format("{}{} faces and {} nodes in '{}'", i == 0 ? "" : ", ", n_faces, n_nodes,
                            contacts.left_out[i]);
      }
      return "Contact leaves out what never touches each other: " + text;
    }
  } // namespace

  void
  suit_body_contacts(BodyContacts             &contacts,
                     const ContactSurface     &surface,
                     const Vector             &rest_positions,
                     const Vector             &positions,
                     std::vector<std::string> &notes)
  {
    if (!contacts.left_out.empty())
      notes.push_back(left_out_note(contacts, surface));
    const StandingSurface at_rest(contacts, surface, rest_positions);
    SpaceVector3          first_place;
    const auto            leave_out = [&](const StandingSurface::Near &near)
    {
      double &width
          = contacts.own_widths.try_emplace(near.pair.key(), contacts.width).first->second;
      if (width > 0. && contacts.n_left_out++ == 0)
        first_place = near.place;
      width = 0.;
    };
    const auto keep_half = [&](const StandingSurface::Near &near)
    {
      double &width
          = contacts.own_widths.try_emplace(near.pair.key(), contacts.width).first->second;
      width = std::min(width, 0.5 * near.distance);
    };
    const double least = touching * contacts.diameter;
    for (const StandingSurface::Near &near : at_rest.near_pairs())
      near.distance < least ? leave_out(near) : keep_half(near);
    for (const StandingSurface::Near &near : at_rest.crossing_pairs())
      leave_out(near);
    if (contacts.n_left_out > 0)
      notes.push_back(
          fmt::format("Contact leaves out {} pairs of parts of the surface that touch or "
                      "cross at rest, the first near {} m",
                      contacts.n_left_out, place_text(first_place)));
    const StandingSurface at_start(contacts, surface, positions);
    const auto            refuse = [](const StandingSurface::Near &near)
    {
      throw UserError(
          "The surface of the body meets itself or another piece near " + place_text(near.place)
          + " m where the scene begins, but not at rest. Choose another Initial/Pose, or set "
            "Contact/Self and Contact/Bodies = false.");
    };
    for (const StandingSurface::Near &near : at_start.near_pairs())
      near.distance < least ? refuse(near) : keep_half(near);
    for (const StandingSurface::Near &near : at_start.crossing_pairs())
      if (contacts.width_of(near.pair) > 0.)
        refuse(near);
  }

  std::string
  crossing_pose_warning(const BodyContacts   &contacts,
                        const ContactSurface &surface,
                        const Vector         &pose,
                        const std::string    &name)
  {
    for (const StandingSurface::Near &near :
         StandingSurface(contacts, surface, pose).crossing_pairs())
      if (contacts.width_of(near.pair) > 0.)
        return name + ": the surface meets itself or another piece in this pose, near "
               + place_text(near.place)
               + " m, but not at rest. With Contact the body cannot come all of the way to it; a "
                 "pose without this is followed better.";
    return "";
  }
} // namespace Exemplar
