// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/problem/body_contact_start.h>
#include <exemplar/run/problem/pieces_at_start.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Of the piece's diameter: parts of one piece that are nearer touch.
    constexpr double touching = 1e-9;

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

  namespace
  {
    /// The pairs of two parts of one piece.
    std::vector<StandingSurface::Near>
    of_one_piece(std::vector<StandingSurface::Near> pairs,
                 const BodyContacts                &contacts,
                 const ContactSurface              &surface)
    {
      const auto has_two = [&](const StandingSurface::Near &near)
      {
        const PiecePair of = contacts.pieces_of(surface, near.pair);
        return of.first != of.second;
      };
      pairs.erase(std::remove_if(pairs.begin(), pairs.end(), has_two), pairs.end());
      return pairs;
    }

    /// Let pairs of one piece that are near each other at rest or where the scene begins push from half of their distance on, and leave out
    /// what touches or crosses at rest.
    void
    suit_single_pieces(BodyContacts             &contacts,
                       const ContactSurface     &surface,
                       const Vector             &rest_positions,
                       const Vector             &positions,
                       std::vector<std::string> &notes)
    {
      const auto near_pairs = [&](const StandingSurface &at)
      { return of_one_piece(at.near_pairs(), contacts, surface); };
      const auto crossing_pairs = [&](const StandingSurface &at)
      { return of_one_piece(at.crossing_pairs(), contacts, surface); };
      const auto usual_of = [&](const StandingSurface::Near &near)
      { return contacts.usual_width(contacts.pieces_of(surface, near.pair)); };
      const auto touches = [&](const StandingSurface::Near &near)
      {
        const PiecePair of = contacts.pieces_of(surface, near.pair);
        return near.distance < touching * contacts.diameters[of.first];
      };
      const StandingSurface  at_rest(contacts, surface, rest_positions);
      StandingSurface::Place first_place;
      const auto             leave_out = [&](const StandingSurface::Near &near)
      {
        double &width
            = contacts.own_widths.try_emplace(near.pair.key(), usual_of(near)).first->second;
        if (width > 0. && contacts.n_left_out++ == 0)
          first_place = near.place;
        width = 0.;
      };
      const auto keep_half = [&](const StandingSurface::Near &near)
      {
        double &width
            = contacts.own_widths.try_emplace(near.pair.key(), usual_of(near)).first->second;
        width = std::min(width, 0.5 * near.distance);
      };
      for (const StandingSurface::Near &near : near_pairs(at_rest))
        touches(near) ? leave_out(near) : keep_half(near);
      for (const StandingSurface::Near &near : crossing_pairs(at_rest))
        leave_out(near);
      if (contacts.n_left_out > 0)
        notes.push_back(
            fmt::format("Contact leaves out {} pairs of parts of the surface that touch or "
                        "cross at rest, the first near {} m",
                        contacts.n_left_out, place_text(first_place)));
      const StandingSurface at_start(contacts, surface, positions);
      const auto            refuse = [](const StandingSurface::Near &near)
      {
        throw UserError("The surface of the body meets itself near " + place_text(near.place)
                        + " m where the scene begins, but not at rest. Choose another "
                          "Initial/Pose, or set Contact/Self = false.");
      };
      for (const StandingSurface::Near &near : near_pairs(at_start))
        touches(near) ? refuse(near) : keep_half(near);
      for (const StandingSurface::Near &near : crossing_pairs(at_start))
        if (contacts.width_of(surface, near.pair) > 0.)
          refuse(near);
    }
  } // namespace

  void
  suit_body_contacts(BodyContacts             &contacts,
                     const ContactSurface     &surface,
                     const FESpace            &fe_space,
                     const FreeDofs           &free_dofs,
                     Vector                   &positions,
                     std::vector<std::string> &notes)
  {
    if (!contacts.left_out.empty())
      notes.push_back(left_out_note(contacts, surface));
    if (contacts.diameters.size() > 1)
      suit_pieces(contacts, surface, fe_space, free_dofs, positions, notes);
    if (contacts.also_self)
      suit_single_pieces(contacts, surface, fe_space.rest_positions(), positions, notes);
  }

  std::string
  crossing_pose_warning(const BodyContacts   &contacts,
                        const ContactSurface &surface,
                        const Vector         &pose,
                        const std::string    &name)
  {
    for (const StandingSurface::Near &near :
         StandingSurface(contacts, surface, pose).crossing_pairs())
      if (contacts.width_of(surface, near.pair) > 0.)
        return name + ": the surface meets itself or another piece in this pose, near "
               + place_text(near.place)
               + " m, but not at rest. With Contact the body cannot come all of the way to it; a "
                 "pose without this is followed better.";
    return "";
  }
} // namespace Exemplar
