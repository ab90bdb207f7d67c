// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_contacts_h
#define exemplar_body_contacts_h

#include <exemplar/obstacles/contact_parameters.h>
#include <exemplar/obstacles/contact_surface.h>

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

  /// Which parts of a body's surface may meet, and from where they push each other.
  struct BodyContacts
  {
    /// `named` has the nodes of selections by their texts. Throws UserError as contact_distance().
    BodyContacts(const ContactParameters &parameters,
                 const Mesh              &mesh,
                 const FESpace           &fe_space,
                 const NamedNodes        &named = {});

    /// Whether a pair counts unless it has no width: it has no node in common, and is of pieces and selections that may meet.
    bool
    may_meet(const ContactSurface &surface, const BodyPair &pair) const;

    /// From where a pair pushes [m]; 0: it is left out.
    double
    width_of(const BodyPair &pair) const
    {
      const auto found = own_widths.find(pair.key());
      return found == own_widths.end() ? width : found->second;
    }

    double                    width;          ///< d_hat: from where others push [m]
    double                    diameter;       ///< of the largest piece [m]
    double                    friction;       ///< coefficient [-]
    double                    slip_speed;     ///< [m/s]
    bool                      also_self;      ///< also parts of one piece
    std::vector<unsigned int> pieces;         ///< of the nodes
    unsigned int              n_left_out = 0; ///< pairs
    /// Of pairs that are nearer than `width` at rest or where the body begins: half of that, or 0 for those that are left out.
    std::unordered_map<std::uint64_t, double> own_widths;
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
