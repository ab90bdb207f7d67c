// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/closest_features.h>
#include <exemplar/obstacles/contact_parameters.h>
#include <exemplar/obstacles/ties.h>
#include <exemplar/prm/key_table.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace Exemplar
{
  namespace
  {
    constexpr double usual_reach = 0.05; ///< of the mesh's diameter
    constexpr double greatest_share
        = 10.; ///< of a cell's node: beyond it a cell's motion is not continued

    std::string
    place_in_words(const dealii::Point<3> &x)
    {
      return "(" + short_text(x[0]) + ", " + short_text(x[1]) + ", " + short_text(x[2]) + ") m";
    }

    /// Barycentric coordinates of a point in the tetrahedron of a cell's vertices.
    std::array<double, 4>
    coordinates_in(const FESpace &fe_space, const unsigned int cell, const dealii::Point<3> &x)
    {
      const auto             nodes  = fe_space.nodes(cell);
      const dealii::Point<3> origin = fe_space.rest_position(nodes[0]);
      dealii::Tensor<2, 3>   edges; // columns
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int c = 0; c < 3; ++c)
          edges[c][k] = fe_space.rest_position(nodes[k + 1])[c] - origin[c];
      const dealii::Tensor<1, 3> part = invert(edges) * (x - origin);
      return { { 1. - part[0] - part[1] - part[2], part[0], part[1], part[2] } };
    }

    /// Values of the cell's shape functions at these barycentric coordinates, in the order of FESpace::nodes().
    std::vector<double>
    shape_values(const std::array<double, 4> &l, const std::size_t n_nodes)
    {
      if (n_nodes == 4)
        return { l.begin(), l.end() };
      std::vector<double> values;
      for (const double one : l)
        values.push_back(one * (2. * one - 1.));
      for (const auto &[a, b] :
           { std::pair(0, 1), { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } })
        values.push_back(4. * l.at(a) * l.at(b));
      return values;
    }

    /// What nodes can be tied to: cells and triangles of To.
    class TieTarget
    {
    public:
      TieTarget(const TieParameters             &parameters,
                const Mesh                      &mesh,
                const FESpace                   &fe_space,
                const ContactSurface            &surface,
                const std::vector<unsigned int> &pieces,
                const NamedNodes                &named)
          : fe_space(fe_space), surface(surface), pieces(pieces)
      {
        std::vector<bool> is_meant(fe_space.n_nodes(), parameters.to.text.empty());
        if (!parameters.to.text.empty())
          for (const unsigned int node : fe_space.numbering().with_middles(
                   parameters.to.nodes(mesh, "Ties/" + parameters.name + "/To", named)))
            is_meant[node] = true;
        std::set<unsigned int> of_pieces;
        std::vector<AxisBox>   boxes;
        for (unsigned int t = 0; t < surface.triangles.size(); ++t)
          if (const auto &nodes = surface.triangles[t].nodes; std::all_of(
                  nodes.begin(), nodes.end(), [&](const unsigned int n) { return is_meant[n]; }))
          {
            triangles.push_back(t);
            of_pieces.insert(pieces[nodes[0]]);
            boxes.push_back(box_of(nodes));
          }
        tree_of_triangles = BoxTree(boxes);
        boxes.clear();
        for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
          if (of_pieces.count(pieces[fe_space.nodes(cell)[0]]) > 0)
          {
            cells.push_back(cell);
            boxes.push_back(box_of(mesh.get_cells()[cell]));
          }
        tree_of_cells = BoxTree(boxes);
      }

      bool
      empty() const
      {
        return triangles.empty();
      }

      /// The first cell of another piece in which the node is at rest.
      std::optional<unsigned int>
      cell_around(const unsigned int node) const
      {
        constexpr double          rounding = 1e-9;
        const auto                x        = fe_space.rest_position(node);
        std::vector<unsigned int> found;
        tree_of_cells.visit(box_of(std::array<unsigned int, 1>{ { node } }),
                            [&](const unsigned int i)
                            {
                              const auto l = coordinates_in(fe_space, cells[i], x);
                              if (piece_of_cell(cells[i]) != pieces[node]
                                  && *std::min_element(l.begin(), l.end()) >= -rounding)
                                found.push_back(cells[i]);
                            });
        if (found.empty())
          return {};
        return *std::min_element(found.begin(), found.end());
      }

      /// A triangle of another piece that the node faces, and how far it is [m].
      struct Faced
      {
        unsigned int triangle;
        double       distance;
      };

      /// The nearest one within reach.
      std::optional<Faced>
      faced_by(const unsigned int node, const SpaceVector3 &normal, const double reach) const
      {
        const SpaceVector3   x = fe_space.rest_position(node);
        std::optional<Faced> best;
        tree_of_triangles.visit(
            box_of(std::array<unsigned int, 1>{ { node } }).widened(reach),
            [&](const unsigned int i)
            {
              const auto &nodes = surface.triangles[triangles[i]].nodes;
              if (pieces[nodes[0]] == pieces[node])
                return;
              const std::array<SpaceVector3, 3> corners{ { at_rest(nodes[0]), at_rest(nodes[1]),
                                                           at_rest(nodes[2]) } };
              const SpaceVector3                of_triangle
                  = dealii::cross_product_3d(corners[1] - corners[0], corners[2] - corners[0]);
              const SpaceVector3 way = nearest(corners, x).way;
              if (normal * of_triangle >= 0. || way * normal < 0. || way * of_triangle > 0.
                  || way.norm() > reach)
                return;
              const Faced now{ triangles[i], way.norm() };
              if (!best || now.distance < best->distance
                  || (now.distance == best->distance && now.triangle < best->triangle))
                best = now;
            });
        return best;
      }

      unsigned int
      piece_of_cell(const unsigned int cell) const
      {
        return pieces[fe_space.nodes(cell)[0]];
      }

    private:
      SpaceVector3
      at_rest(const unsigned int node) const
      {
        return fe_space.rest_position(node);
      }

      template <typename Nodes>
      AxisBox
      box_of(const Nodes &nodes) const
      {
        AxisBox box;
        for (const unsigned int node : nodes)
          box.add(at_rest(node));
        return box.widened(1e-9 * (box.high - box.low).norm());
      }

      const FESpace                   &fe_space;
      const ContactSurface            &surface;
      const std::vector<unsigned int> &pieces;
      std::vector<unsigned int>        triangles, cells; ///< ascending
      BoxTree                          tree_of_triangles, tree_of_cells;
    };

    /// Of the surface at each node, outwards, by area; 0 inside of the body.
    std::vector<SpaceVector3>
    normals_of_nodes(const ContactSurface &surface, const FESpace &fe_space)
    {
      std::vector<SpaceVector3> normals(fe_space.n_nodes());
      for (const ContactSurface::Triangle &triangle : surface.triangles)
      {
        const auto x
            = [&](const unsigned int k) { return fe_space.rest_position(triangle.nodes[k]); };
        for (const unsigned int node : triangle.nodes)
          normals[node] += dealii::cross_product_3d(x(1) - x(0), x(2) - x(0));
      }
      return normals;
    }

    /// Give the ties their areas: a third of the triangles between tied nodes, or of all at a node without such a one.
    void
    share_areas(const ContactSurface &surface, const FESpace &fe_space, std::vector<Tie> &ties)
    {
      std::vector<bool> is_tied(fe_space.n_nodes(), false);
      for (const Tie &tie : ties)
        is_tied[tie.node] = true;
      std::vector<double> between(fe_space.n_nodes(), 0.), all(fe_space.n_nodes(), 0.);
      for (const ContactSurface::Triangle &triangle : surface.triangles)
      {
        const bool is_between = std::all_of(triangle.nodes.begin(), triangle.nodes.end(),
                                            [&](const unsigned int node) { return is_tied[node]; });
        for (const unsigned int node : triangle.nodes)
        {
          all[node] += triangle.area / 3.;
          between[node] += is_between ? triangle.area / 3. : 0.;
        }
      }
      for (Tie &tie : ties)
        tie.area = between[tie.node] > 0. ? between[tie.node] : all[tie.node];
    }

    /// Ties the nodes of a subsection.
    class TieMaker
    {
    public:
      TieMaker(const TieParameters             &parameters,
               const Mesh                      &mesh,
               const FESpace                   &fe_space,
               const ContactSurface            &surface,
               const std::vector<unsigned int> &pieces,
               const NamedNodes                &named)
          : key("Ties/" + parameters.name), fe_space(fe_space), surface(surface),
            normals(normals_of_nodes(surface, fe_space)), cells(fe_space.n_nodes()),
            target(parameters, mesh, fe_space, surface, pieces, named),
            reach(parameters.reach == "auto" ? usual_reach * mesh.diameter()
                                             : parse_number(parameters.reach)),
            far(10. * mesh.diameter())
      {
        for (const ContactSurface::Triangle &triangle : surface.triangles)
          for (const unsigned int node : triangle.nodes)
            cells[node] = triangle.cell;
        if (target.empty())
          throw UserError(
              key + "/To = '" + parameters.to.text
              + "' holds no triangle of the surface whole. Nodes are tied to the surface "
                "of another piece, or to places in it: enlarge To.");
        for (const unsigned int node : fe_space.numbering().with_middles(
                 parameters.select.nodes(mesh, key + "/Select", named)))
          if (normals[node].norm() > 0.) // of the surface
            add(node);
        if (ties.empty())
          throw UserError(key + " reaches nothing: " + loose_in_words() + remedy());
        share_areas(surface, fe_space, ties);
      }

      /// What was not tied, in words; empty if nothing.
      std::string
      note() const
      {
        return loose.empty() ? ""
                             : fmt::format("{} ties {} nodes of the surface; {}", key, ties.size(),
                                           loose_in_words());
      }

      std::vector<Tie> ties;

    private:
      void
      add(const unsigned int node)
      {
        std::optional<unsigned int> cell = target.cell_around(node);
        if (!cell)
        {
          const auto faced = target.faced_by(node, normals[node], reach);
          if (!faced)
          {
            loose.push_back(node);
            return;
          }
          cell = surface.triangles[faced->triangle].cell;
        }
        const auto nodes = fe_space.nodes(*cell);
        const auto shares
            = shape_values(coordinates_in(fe_space, *cell, place_of(node)), nodes.size());
        for (const double share : shares)
          if (std::abs(share) > greatest_share)
            throw UserError(
                key + ": the node at " + place_in_words(place_of(node))
                + " is so far from what it would be tied to that the motion of the cell "
                  "there says nothing about it. Move the pieces together, take larger "
                  "cells there, or lessen "
                + key + "/Reach.");
        ties.push_back({ node,
                         { nodes.begin(), nodes.end() },
                         shares,
                         cells[node],
                         *cell,
                         target.piece_of_cell(*cell) });
      }

      dealii::Point<3>
      place_of(const unsigned int node) const
      {
        return fe_space.rest_position(node);
      }

      std::string
      loose_in_words() const
      {
        if (loose.empty())
          return "Select holds no node of the surface.";
        return fmt::format("{} nodes of Select face nothing of To within {} m, the first at {}",
                           loose.size(), short_text(reach), place_in_words(place_of(loose[0])));
      }

      /// What helps where nothing is tied.
      std::string
      remedy() const
      {
        if (loose.empty())
          return " Select nodes of the surface.";
        const auto faced = target.faced_by(loose[0], normals[loose[0]], far);
        return faced
                   ? ", which faces it from " + short_text(faced->distance)
                         + " m away. Enlarge Reach, or move the pieces together."
                   : ", which looks away from it. Select nodes whose surface looks at To, such as "
                     "the inner side of a skin.";
      }

      const std::string               key;
      const FESpace                  &fe_space;
      const ContactSurface           &surface;
      const std::vector<SpaceVector3> normals;
      std::vector<unsigned int>       cells; ///< one of each node of the surface
      const TieTarget                 target;
      const double                    reach, far; ///< [m]
      std::vector<unsigned int>       loose;      ///< selected nodes that are not tied
    };
  } // namespace

  void
  TieParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection(name);
    select.declare(keys, "Which nodes are tied; those on the surface of the body count");
    keys.add("To", to.text,
             "What they are tied to, as Select: the pieces that these nodes belong to, and of "
             "their surface the triangles between them. Empty: all other pieces. A node in a cell "
             "is tied to that place, another one to the nearest place of the surface that it "
             "faces.",
             " ");
    keys.add("Stiffness", stiffness,
             "Force between the two [N] for a metre of distance and a square metre of the tied "
             "surface, > 0 [N/m^3]; or rigid: so stiff that the softer side yields 1e4 times as "
             "much.");
    keys.add("Reach", reach,
             "How far from To nodes are tied that are not in it [m]; auto: 0.05 of the body's "
             "diameter.");
    keys.leave_subsection();
  }

  void
  TieParameters::check() const
  {
    if (stiffness != "rigid"
        && !(parse_number(stiffness) > 0. && std::isfinite(parse_number(stiffness))))
      throw UserError("Ties/" + name + "/Stiffness = '" + stiffness
                      + "' is not allowed. Allowed: rigid, or a positive number [N/m^3].");
    check_length(reach, "Ties/" + name + "/Reach", "m");
  }

  Ties::Ties(const std::vector<TieParameters> &parameters,
             const Mesh                       &mesh,
             const FESpace                    &fe_space,
             const NamedNodes                 &named)
  {
    if (parameters.empty())
      return;
    if (mesh.n_pieces() == 1)
      throw UserError("Ties/Names lists what ties pieces of the mesh to each other, but "
                      + mesh.get_name() + " is in one piece. Leave Ties/Names empty.");
    const ContactSurface            surface(mesh, fe_space);
    const std::vector<unsigned int> pieces = fe_space.numbering().pieces();
    for (const TieParameters &one : parameters)
    {
      TieMaker maker(one, mesh, fe_space, surface, pieces, named);
      if (const std::string note = maker.note(); !note.empty())
        notes.push_back(note);
      groups.push_back({ one.name, one.stiffness == "rigid" ? 0. : parse_number(one.stiffness),
                         std::move(maker.ties) });
    }
    joined.resize(mesh.n_pieces());
    std::iota(joined.begin(), joined.end(), 0u);
    join_pieces(fe_space, pieces);
  }

  void
  Ties::join_pieces(const FESpace &fe_space, const std::vector<unsigned int> &piece_of_node)
  {
    std::map<std::pair<unsigned int, unsigned int>, std::vector<dealii::Point<3>>> places;
    for (const Group &group : groups)
      for (const Tie &tie : group.ties)
        places[std::minmax({ piece_of_node[tie.node], tie.piece })].push_back(
            fe_space.rest_position(tie.node));
    for (const auto &[pair, of_pair] : places)
      if (of_pair.size() >= 3 && !are_collinear(of_pair))
      {
        const unsigned int one = joined[pair.first], other = joined[pair.second];
        std::replace(joined.begin(), joined.end(), std::max(one, other), std::min(one, other));
      }
  }

  std::set<std::pair<unsigned int, unsigned int>>
  Ties::pieces_of_nodes() const
  {
    std::set<std::pair<unsigned int, unsigned int>> all;
    for (const Group &group : groups)
      for (const Tie &tie : group.ties)
        all.emplace(tie.node, tie.piece);
    return all;
  }

  std::size_t
  Ties::memory_consumption() const
  {
    std::size_t bytes = joined.size() * sizeof(unsigned int);
    for (const Group &group : groups)
      for (const Tie &tie : group.ties)
        bytes += sizeof(Tie) + tie.others.size() * (sizeof(unsigned int) + sizeof(double));
    return bytes;
  }
} // namespace Exemplar
