// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/body_contacts.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// The greatest number that a pair of pieces has, of which each has the lesser number of both.
    double
    greatest_of_pairs(std::vector<double> of_pieces, const bool also_self)
    {
      std::sort(of_pieces.rbegin(), of_pieces.rend());
      return of_pieces[also_self || of_pieces.size() == 1 ? 0 : 1];
    }

    bool
    has_several_bits(const std::uint64_t bits)
    {
      return (bits & (bits - 1)) != 0;
    }
  } // namespace

  BodyContacts::BodyContacts(const ContactParameters &parameters,
                             const Mesh              &mesh,
                             const FESpace           &fe_space,
                             const NamedNodes        &named)
      : friction(parameters.friction), also_self(parameters.self)
  {
    const PieceSizes sizes(mesh, fe_space);
    const double     largest = *std::max_element(sizes.diameters.begin(), sizes.diameters.end());
    pieces                   = sizes.pieces;
    diameters                = sizes.diameters;
    widths = contact_distances(parameters.distance, "Contact/Distance", largest, sizes).of_pieces;
    width  = greatest_of_pairs(widths, also_self);
    slip_speeds = contact_slip_speeds(parameters.slip_speed, sizes);
    for (const auto &[selection, key] : parameters.selections())
    {
      selections.resize(fe_space.n_nodes(), 0);
      for (const unsigned int node :
           fe_space.numbering().with_middles(selection.nodes(mesh, key, named)))
        selections[node] |= std::uint64_t(1) << left_out.size();
      left_out.push_back(selection.text);
    }
  }

  PiecePair
  BodyContacts::pieces_of(const ContactSurface &surface, const BodyPair &pair) const
  {
    if (pair.kind == BodyPairKind::edge_edge)
      return std::minmax(pieces[surface.edges[pair.first].nodes[0]],
                         pieces[surface.edges[pair.second].nodes[0]]);
    return std::minmax(pieces[surface.nodes[pair.first].node],
                       pieces[surface.triangles[pair.second].nodes[0]]);
  }

  double
  BodyContacts::width_of(const ContactSurface &surface, const BodyPair &pair) const
  {
    if (const auto found = own_widths.find(pair.key()); found != own_widths.end())
      return found->second;
    if (widths.size() == 1 && joint_widths.empty())
      return widths[0];
    const PiecePair of    = pieces_of(surface, pair);
    const auto      joint = joint_widths.find(key_of(of));
    return joint == joint_widths.end() ? usual_width(of) : joint->second.width;
  }

  std::pair<BodyPair, double>
  BodyContacts::origin_of_width(const ContactSurface &surface, const BodyPair &pair) const
  {
    if (own_widths.count(pair.key()) > 0)
      return { pair, 0.5 };
    const auto joint = joint_widths.find(key_of(pieces_of(surface, pair)));
    return joint == joint_widths.end() ? std::pair(pair, 0.) : std::pair(joint->second.nearest, 1.);
  }

  bool
  BodyContacts::is_left_out(const std::uint64_t of_one, const std::uint64_t of_other) const
  {
    if (of_one == 0 || of_other == 0)
      return false;
    return left_out.size() == 1 || of_one != of_other || has_several_bits(of_one);
  }

  bool
  BodyContacts::may_meet(const ContactSurface &surface, const BodyPair &pair) const
  {
    const auto of_all = [&](const auto &nodes) // a part lies where all of its nodes do
    {
      std::uint64_t common = ~std::uint64_t(0);
      for (const unsigned int node : nodes)
        common &= selections_of(node);
      return common;
    };
    const auto are_tied = [&](const auto &nodes, const unsigned int piece)
    {
      return std::any_of(nodes.begin(), nodes.end(),
                         [&](const unsigned int node) {
                           return tied.count({ node, piece }) > 0;
                         });
    };
    const auto may = [&](const auto &nodes, const auto &others)
    {
      return (also_self || pieces[nodes[0]] != pieces[others[0]])
             && !have_a_common_node(nodes, others)
             && (left_out.empty() || !is_left_out(of_all(nodes), of_all(others)))
             && (tied.empty()
                 || (!are_tied(nodes, pieces[others[0]]) && !are_tied(others, pieces[nodes[0]])));
    };
    if (pair.kind == BodyPairKind::edge_edge)
      return may(surface.edges[pair.first].nodes, surface.edges[pair.second].nodes);
    return may(std::array<unsigned int, 1>{ { surface.nodes[pair.first].node } },
               surface.triangles[pair.second].nodes);
  }
} // namespace Exemplar
