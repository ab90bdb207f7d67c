// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_contacts_h
#define exemplar_body_contacts_h

#include <exemplar/obstacles/contact_parameters.h>
#include <exemplar/obstacles/contact_points.h>
#include <exemplar/obstacles/contact_surface.h>
#include <exemplar/obstacles/piece_sizes.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// What of the body meets what of the body.
  enum class BodyPairKind
  {
    node_triangle,
    edge_edge
  };

  /// Whether two parts, by their nodes, have one in common.
  template <typename Nodes, typename OtherNodes>
  bool
  have_a_common_node(const Nodes &nodes, const OtherNodes &others)
  {
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](const unsigned int node)
                       { return std::count(others.begin(), others.end(), node) > 0; });
  }

  /// Two parts of a ContactSurface, by their numbers. Of edges the first has the lesser one.
  struct BodyPair
  {
    BodyPairKind kind;
    unsigned int first, second;

    /// Ascending with kind, first and second.
    std::uint64_t
    key() const
    {
      return static_cast<std::uint64_t>(kind) << 62U | static_cast<std::uint64_t>(first) << 31U
             | second;
    }
  };

  /// Two pieces by their numbers, in ascending order, or one piece twice.
  using PiecePair = std::pair<unsigned int, unsigned int>;

  /// Which parts of a body's surface may meet, and from where they push each other.
  struct BodyContacts
  {
    /// `named` has the nodes of selections by their texts. Throws UserError as contact_distances().
    BodyContacts(const ContactParameters &parameters,
                 const Mesh              &mesh,
                 const FESpace           &fe_space,
                 const NamedNodes        &named = {});

    /// Whether a pair counts unless it has no width: it has no node in common, and is of pieces and selections that may meet.
    bool
    may_meet(const ContactSurface &surface, const BodyPair &pair) const;

    /// From where a pair pushes [m]; 0: it is left out.
    double
    width_of(const ContactSurface &surface, const BodyPair &pair) const;

    /// The pair whose distance where the scene begins the width of a pair is a part of, and that part; 0: it has the usual width.
    std::pair<BodyPair, double>
    origin_of_width(const ContactSurface &surface, const BodyPair &pair) const;

    /// From where pairs of these pieces push unless they begin nearer [m].
    double
    usual_width(const PiecePair &of) const
    {
      return widths.size() == 1 ? widths[0] : std::min(widths[of.first], widths[of.second]);
    }

    /// The pieces of both parts of a pair.
    PiecePair
    pieces_of(const ContactSurface &surface, const BodyPair &pair) const;

    std::vector<double>       diameters;      ///< of the pieces [m]
    std::vector<double>       widths;         ///< d_hat of each piece, or one of all [m]
    double                    width;          ///< the greatest one that a pair has [m]
    double                    friction;       ///< coefficient [-]
    PieceLengths              slip_speeds;    ///< [m/s]
    bool                      also_self;      ///< also parts of one piece
    std::vector<unsigned int> pieces;         ///< of the nodes
    unsigned int              n_left_out = 0; ///< pairs
    /// Of pairs that are nearer than their width at rest or where the body begins: half of that, or 0 for those that are left out.
    std::unordered_map<std::uint64_t, double> own_widths;

    /// What two pieces that begin near each other have in place of their usual width.
    struct JointWidth
    {
      double   width;   ///< their least distance then [m]
      BodyPair nearest; ///< the pair that has it
    };

    /// By key_of() the pieces.
    std::unordered_map<std::uint64_t, JointWidth> joint_widths;
    ContactPoints                                 points; ///< in place of the nodes
    bool pieces_were_moved = false; ///< where the scene begins, as they touch at rest

    static std::uint64_t
    key_of(const PiecePair &of)
    {
      return static_cast<std::uint64_t>(of.first) << 32U | of.second;
    }

    std::vector<std::string> left_out; ///< texts of the selections that never touch each other
    /// Nodes that are tied, with the pieces that they are tied to and do not meet.
    std::set<std::pair<unsigned int, unsigned int>> tied;

    /// In which of these selections a node lies, a bit each.
    std::uint64_t
    selections_of(const unsigned int node) const
    {
      return selections.empty() ? 0 : selections[node];
    }

  private:
    /// Whether what lies in these selections never touches what lies in those.
    bool
    is_left_out(std::uint64_t of_one, std::uint64_t of_other) const;

    std::vector<std::uint64_t> selections; ///< of the nodes; empty: there are none
  };
} // namespace Exemplar

#endif
