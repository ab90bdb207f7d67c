// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/obstacles/body_contacts.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// The diagonal of the box around the largest piece [m].
    double
    diameter_of_largest(const Mesh &mesh)
    {
      std::vector<std::vector<dealii::Point<3>>> nodes(mesh.n_pieces());
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        for (const unsigned int node : mesh.corners(cell))
          nodes[mesh.piece_of(cell)].push_back(mesh.get_nodes()[node]);
      double largest = 0.;
      for (const auto &of_piece : nodes)
        largest = std::max(largest, box_diagonal(of_piece));
      return largest;
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
      : diameter(diameter_of_largest(mesh)), friction(parameters.friction),
        slip_speed(parameters.slip_speed == "auto" ? 1e-3 * diameter
                                                   : parse_number(parameters.slip_speed)),
        also_self(parameters.self), pieces(fe_space.numbering().pieces())
  {
    width = contact_distance(parameters.distance, "Contact/Distance", diameter);
    for (const auto &[selection, key] : parameters.selections())
    {
      selections.resize(fe_space.n_nodes(), 0);
      for (const unsigned int node :
           fe_space.numbering().with_middles(selection.nodes(mesh, key, named)))
        selections[node] |= std::uint64_t(1) << left_out.size();
      left_out.push_back(selection.text);
    }
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
