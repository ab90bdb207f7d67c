// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/run/problem/piece_overlap.h>
#include <exemplar/run/problem/pieces_apart.h>
#include <exemplar/run/problem/pieces_at_start.h>

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    // parts of the distance from which contact pushes: how far pieces that touch are from each other, and how much nearer they may be
    // if they overlap
    constexpr double set_back_part = 2e-2, enough_apart = 0.5;

    /// How two pieces stand to each other.
    struct Standing
    {
      double   least = std::numeric_limits<double>::infinity(); ///< distance of a pair [m]
      BodyPair nearest{};
      StandingSurface::Place place;
      bool                   is_crossed = false;
      std::set<unsigned int> touching,
          near; ///< nodes of pairs that touch, and of all that are near
    };

    /// Two pieces that touch, and the depth below both surfaces, together, from which contact counts [m].
    struct Joint
    {
      double                 depth, too_little = 0., most;
      std::set<unsigned int> touching, near;
      StandingSurface::Place place;
      bool                   overlaps;
      bool                   is_settled = false, is_hopeless = false;
      bool was_enough = false; ///< whether a depth was, of which `most` is the least then
    };

    class PiecesAtStart
    {
    public:
      PiecesAtStart(BodyContacts         &contacts,
                    const ContactSurface &surface,
                    const FESpace        &fe_space,
                    const FreeDofs       &free_dofs,
                    Vector               &positions)
          : contacts(contacts), surface(surface), fe_space(fe_space), free_dofs(free_dofs),
            positions(positions), drawn(positions)
      {
      }

      void
      suit(std::vector<std::string> &notes)
      {
        refuse_enclosed_pieces();
        std::map<PiecePair, Standing> seen = look();
        find_joints(seen);
        if (!joints.empty())
        {
          move_apart(seen, notes);
          seen = look();
        }
        if (!joints.empty())
        {
          set_back();
          notes.push_back(note());
          seen = look();
        }
        for (const auto &[of, standing] : seen)
          if (is_enough(of, standing))
            contacts.joint_widths[BodyContacts::key_of(of)] = { standing.least, standing.nearest };
        leave_out_hopeless();
      }

    private:
      double
      least_of(const PiecePair &of) const
      {
        return set_back_part * contacts.usual_width(of);
      }

      std::vector<unsigned int>
      nodes_of(const BodyPair &pair) const
      {
        std::vector<unsigned int> nodes;
        const auto                add = [&](const auto &of_part)
        { nodes.insert(nodes.end(), of_part.begin(), of_part.end()); };
        if (pair.kind == BodyPairKind::edge_edge)
        {
          add(surface.edges[pair.first].nodes);
          add(surface.edges[pair.second].nodes);
          return nodes;
        }
        add(surface.triangles[pair.second].nodes);
        nodes.push_back(surface.nodes[pair.first].node);
        return nodes;
      }

      /// The pieces that are near each other.
      std::map<PiecePair, Standing>
      look() const
      {
        const StandingSurface         at(contacts, surface, positions);
        std::map<PiecePair, Standing> result;
        for (const StandingSurface::Near &near : at.near_pairs())
        {
          const PiecePair of = contacts.pieces_of(surface, near.pair);
          if (of.first == of.second)
            continue;
          Standing &standing = result[of];
          if (near.distance < standing.least)
          {
            standing.least   = near.distance;
            standing.nearest = near.pair;
            standing.place   = near.place;
          }
          for (const unsigned int node : nodes_of(near.pair))
          {
            standing.near.insert(node);
            if (near.distance < least_of(of))
              standing.touching.insert(node);
          }
        }
        for (const StandingSurface::Near &near : at.crossing_pairs())
        {
          const PiecePair of = contacts.pieces_of(surface, near.pair);
          if (of.first == of.second)
            continue;
          Standing &standing = result[of];
          if (!standing.is_crossed)
            standing.place = near.place;
          standing.is_crossed = true;
          for (const unsigned int node : nodes_of(near.pair))
            standing.near.insert(node);
        }
        return result;
      }

      void
      find_joints(std::map<PiecePair, Standing> &seen)
      {
        for (auto &[of, standing] : seen)
          if (standing.is_crossed || standing.least < least_of(of))
          {
            Joint joint;
            joint.depth    = least_of(of);
            joint.most     = contacts.usual_width(of) + least_of(of);
            joint.overlaps = standing.is_crossed;
            joint.place    = standing.place;
            joint.touching.swap(standing.touching);
            joint.near.swap(standing.near);
            joints.emplace(of, std::move(joint));
          }
      }

      /// The pieces that handles hold.
      std::set<unsigned int>
      held_pieces() const
      {
        std::set<unsigned int> result;
        for (unsigned int dof = 0; dof < free_dofs.n_dofs(); ++dof)
          if (free_dofs.free_index(dof) == FreeDofs::held)
            result.insert(contacts.pieces[dof / 3]);
        return result;
      }

      /// Move pieces as wholes such that they are apart. Joints are left where that does not do.
      void
      move_apart(const std::map<PiecePair, Standing> &near, std::vector<std::string> &notes)
      {
        // those that do not touch must not come to that
        std::map<PiecePair, TouchingPieces> pairs;
        for (const auto &[of, standing] : near)
          pairs[of] = { least_of(of), contacts.usual_width(of) };
        const auto ways = ways_of_pieces_apart(pairs, contacts, surface, positions, held_pieces());
        if (ways.empty())
          return;
        double farthest = 0.;
        for (unsigned int node = 0; node < fe_space.n_nodes(); ++node)
        {
          const StandingSurface::Place &way = ways[contacts.pieces[node]];
          farthest                          = std::max(farthest, way.norm());
          add_to(positions, node, way);
        }
        const std::map<PiecePair, Standing> seen     = look();
        const auto                          is_apart = [&](const PiecePair &of)
        {
          const auto found = seen.find(of);
          return found == seen.end() || is_enough(of, found->second);
        };
        // others may have come nearer
        for (const auto &[of, standing] : seen)
          if (!is_enough(of, standing) && joints.count(of) == 0)
          {
            positions = drawn;
            return;
          }
        if (std::none_of(joints.begin(), joints.end(),
                         [&](const auto &joint) { return is_apart(joint.first); }))
        {
          positions = drawn;
          return;
        }
        const std::size_t n_all = joints.size();
        const std::string first = place_text(joints.begin()->second.place);
        for (auto joint = joints.begin(); joint != joints.end();)
          joint = is_apart(joint->first) ? joints.erase(joint) : std::next(joint);
        contacts.pieces_were_moved = true;
        notes.push_back(fmt::format("Contact: {} of pieces touch{} where the scene begins, the "
                                    "first near {} m: pieces begin "
                                    "apart, by displacements of {} m at most",
                                    count_text(n_all - joints.size()),
                                    n_all - joints.size() == 1 ? "es" : "", first,
                                    short_text(farthest)));
      }

      bool
      is_enough(const PiecePair &of, const Standing &standing) const
      {
        return !standing.is_crossed && standing.least >= enough_apart * least_of(of);
      }

      static std::string
      count_text(const std::size_t n)
      {
        return n == 1 ? "1 pair" : fmt::format("{} pairs", n);
      }

      /// Find the depths of all joints, which may have nodes in common.
      void
      set_back()
      {
        std::set<unsigned int> all;
        for (const auto &[of, joint] : joints)
          all.insert(joint.near.begin(), joint.near.end());
        const PointsBelow      below(surface, fe_space, { all.begin(), all.end() });
        constexpr unsigned int max_rounds = 20;
        for (unsigned int round = 0; round < max_rounds; ++round)
        {
          set_points(below);
          bool                                is_last = true;
          const std::map<PiecePair, Standing> seen    = look();
          for (auto &[of, joint] : joints)
          {
            const auto found    = seen.find(of);
            const bool is_apart = found == seen.end() || is_enough(of, found->second);
            is_last &= !take(of, is_apart, joint);
          }
          if (is_last)
            break;
        }
        set_points(below);
      }

      /// Whether the joint has another depth now.
      bool
      take(const PiecePair &of, const bool is_apart, Joint &joint) const
      {
        constexpr double accuracy = 0.1;
        if (joint.is_settled)
          return false;
        const double before = joint.depth;
        if (joint.too_little == 0. && is_apart) // it touches, and no more
          joint.is_settled = true;
        else if (joint.too_little == 0.)
        {
          joint.too_little = joint.depth;
          joint.depth      = joint.most;
        }
        else if (!joint.was_enough && !is_apart)
        {
          if (joint.overlaps)
            refuse(of, joint.place);
          joint.is_settled = joint.is_hopeless = true;
        }
        else
        {
          joint.was_enough                           = true;
          (is_apart ? joint.most : joint.too_little) = joint.depth;
          joint.depth                                = 0.5 * (joint.most + joint.too_little);
          if (joint.most - joint.too_little <= accuracy * joint.most)
          {
            joint.is_settled = true;
            joint.depth      = joint.most;
          }
        }
        return joint.depth != before;
      }

      void
      set_points(const PointsBelow &below)
      {
        std::map<unsigned int, double> depths;
        for (const auto &[of, joint] : joints)
          if (!joint.is_hopeless)
            for (const unsigned int node :
                 joint.too_little > 0. || joint.overlaps ? joint.near : joint.touching)
            {
              double &depth = depths[node];
              depth         = std::max(depth, 0.5 * joint.depth);
            }
        contacts.points.clear();
        for (const auto &[node, depth] : depths)
          contacts.points.set(node, below.point(node, depth));
      }

      /// Pieces whose surfaces cannot be told apart, as at needles' tips.
      void
      leave_out_hopeless()
      {
        for (const auto &[of, joint] : joints)
          if (joint.is_hopeless)
            for (const StandingSurface::Near &near :
                 StandingSurface(contacts, surface, positions).near_pairs())
              if (near.distance < enough_apart * least_of(of)
                  && contacts.pieces_of(surface, near.pair) == of
                  && contacts.own_widths.emplace(near.pair.key(), 0.).second)
                ++contacts.n_left_out;
      }

      std::string
      note() const
      {
        double      greatest = 0.;
        std::size_t n        = 0;
        std::string first;
        for (const auto &[of, joint] : joints)
          if (!joint.is_hopeless)
          {
            greatest = std::max(greatest, 0.5 * joint.depth);
            if (n++ == 0)
              first = place_text(joint.place);
          }
        return fmt::format(
            "Contact: {} of pieces touch{} where the scene begins, the first near {} m: "
            "their surfaces count as set back by {} m at most",
            count_text(n), n == 1 ? "es" : "", first, short_text(greatest));
      }

      void
      refuse_enclosed_pieces() const
      {
        if (const auto enclosed = enclosed_piece(contacts, surface, positions))
          refuse(enclosed->pieces, enclosed->place);
      }

      [[noreturn]] void
      refuse(const PiecePair &of, const StandingSurface::Place &place) const
      {
        const WayApart apart = way_apart(of, contacts, surface, drawn);
        throw UserError(
            fmt::format("Two pieces of the mesh overlap near {} m where the scene begins, by more "
                        "than the {} m "
                        "from which they push each other. A displacement by {} m of the piece with "
                        "its centre at "
                        "{} m would separate them. Move it (in the mesh or by Initial/Pose), name "
                        "parts of both "
                        "in Contact/Leave out, or set Contact/Self and Contact/Bodies = false.",
                        place_text(place), short_text(contacts.usual_width(of)),
                        place_text(apart.way), place_text(apart.centre)));
      }

      BodyContacts              &contacts;
      const ContactSurface      &surface;
      const FESpace             &fe_space;
      const FreeDofs            &free_dofs;
      Vector                    &positions;
      Vector                     drawn; ///< positions before pieces were moved
      std::map<PiecePair, Joint> joints;
    };
  } // namespace

  void
  suit_pieces(BodyContacts             &contacts,
              const ContactSurface     &surface,
              const FESpace            &fe_space,
              const FreeDofs           &free_dofs,
              Vector                   &positions,
              std::vector<std::string> &notes)
  {
    PiecesAtStart(contacts, surface, fe_space, free_dofs, positions).suit(notes);
  }
} // namespace Exemplar
