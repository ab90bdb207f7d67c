// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/closest_features.h>
#include <exemplar/obstacles/solid_angle.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/run/problem/piece_overlap.h>

#include <algorithm>
#include <array>
#include <vector>

namespace Exemplar
{
  namespace
  {
    using Corners = std::array<SpaceVector3, 3>;
    using Ends    = std::array<SpaceVector3, 2>;

    template <typename Points>
    AxisBox
    box_of(const Points &points)
    {
      AxisBox box;
      for (const SpaceVector3 &point : points)
        box.add(point);
      return box;
    }

    /// The surface of a piece in space.
    struct PieceSurface
    {
      PieceSurface(const unsigned int    piece,
                   const BodyContacts   &contacts,
                   const ContactSurface &surface,
                   const Vector         &positions)
      {
        const auto           x = [&](const unsigned int node) { return at_node(positions, node); };
        std::vector<AxisBox> boxes;
        for (const ContactSurface::Triangle &t : surface.triangles)
          if (contacts.pieces[t.nodes[0]] == piece)
          {
            triangles.push_back({ { x(t.nodes[0]), x(t.nodes[1]), x(t.nodes[2]) } });
            boxes.push_back(box_of(triangles.back()));
            around.add(boxes.back());
          }
        for (const ContactSurface::Edge &e : surface.edges)
          if (contacts.pieces[e.nodes[0]] == piece)
            edges.push_back({ { x(e.nodes[0]), x(e.nodes[1]) } });
        tree = BoxTree(boxes);
      }

      bool
      encloses(const SpaceVector3 &point) const
      {
        double angle = 0.;
        for (const Corners &x : triangles)
          angle += solid_angle(point, x);
        return is_full_angle(angle);
      }

      /// Call visit(triangle, edge) where an edge of another surface, moved by `way`, passes through a triangle.
      template <typename Visit>
      void
      visit_crossings(const std::vector<Ends> &of_other,
                      const SpaceVector3      &way,
                      const Visit             &visit) const
      {
        for (const Ends &edge : of_other)
        {
          const Ends moved{ { edge[0] + way, edge[1] + way } };
          tree.visit(box_of(moved),
                     [&](const unsigned int t)
                     {
                       if (passes_through(moved, triangles[t]))
                         visit(t);
                     });
        }
      }

      SpaceVector3
      area_normal(const unsigned int t) const
      {
        const Corners &x = triangles[t];
        return dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]);
      }

      std::vector<Corners> triangles;
      std::vector<Ends>    edges;
      AxisBox              around;
      BoxTree              tree;
    };

    /// Whether two pieces overlap after a displacement of the first one.
    bool
    overlap(const PieceSurface &first, const PieceSurface &second, const SpaceVector3 &way)
    {
      bool       result = false;
      const auto note   = [&](unsigned int) { result = true; };
      second.visit_crossings(first.edges, way, note);
      if (!result)
        first.visit_crossings(second.edges, -way, note);
      return result || second.encloses(first.triangles[0][0] + way)
             || first.encloses(second.triangles[0][0] - way);
    }

    bool
    is_within(const AxisBox &inner, const AxisBox &outer)
    {
      for (unsigned int c = 0; c < 3; ++c)
        if (!(inner.low[c] > outer.low[c] && inner.high[c] < outer.high[c]))
          return false;
      return true;
    }
  } // namespace

  std::optional<EnclosedPiece>
  enclosed_piece(const BodyContacts   &contacts,
                 const ContactSurface &surface,
                 const Vector         &positions)
  {
    const auto           n_pieces = static_cast<unsigned int>(contacts.diameters.size());
    std::vector<AxisBox> boxes(n_pieces);
    for (const ContactSurface::Node &at : surface.nodes)
      boxes[contacts.pieces[at.node]].add(at_node(positions, at.node));
    for (unsigned int inner = 0; inner < n_pieces; ++inner)
      for (unsigned int outer = 0; outer < n_pieces; ++outer)
      {
        if (!is_within(boxes[inner], boxes[outer]))
          continue;
        double       angle    = 0.;
        bool         may_meet = true;
        unsigned int number   = 0;
        while (contacts.pieces[surface.nodes[number].node] != inner)
          ++number;
        const SpaceVector3 point = at_node(positions, surface.nodes[number].node);
        for (unsigned int t = 0; t < surface.triangles.size() && may_meet; ++t)
        {
          const auto &nodes = surface.triangles[t].nodes;
          if (contacts.pieces[nodes[0]] != outer)
            continue;
          may_meet = contacts.may_meet(surface, { BodyPairKind::node_triangle, number, t });
          angle
              += solid_angle(point, { { at_node(positions, nodes[0]), at_node(positions, nodes[1]),
                                        at_node(positions, nodes[2]) } });
        }
        if (may_meet && is_full_angle(angle))
          return EnclosedPiece{ std::minmax(inner, outer), point };
      }
    return {};
  }

  WayApart
  way_apart(const PiecePair      &of,
            const BodyContacts   &contacts,
            const ContactSurface &surface,
            const Vector         &positions)
  {
    const bool         is_first = contacts.diameters[of.first] < contacts.diameters[of.second];
    const PieceSurface moved(is_first ? of.first : of.second, contacts, surface, positions),
        stays(is_first ? of.second : of.first, contacts, surface, positions);
    // out of what stays, where it is crossed
    SpaceVector3 normal;
    stays.visit_crossings(moved.edges, {},
                          [&](const unsigned int t) { normal += stays.area_normal(t); });
    moved.visit_crossings(stays.edges, {},
                          [&](const unsigned int t) { normal -= moved.area_normal(t); });
    std::vector<SpaceVector3> directions;
    for (unsigned int c = 0; c < 3; ++c)
      for (const double sign : { -1., 1. })
      {
        directions.emplace_back();
        directions.back()[c] = sign;
      }
    if (normal.norm() > 0.)
      directions.push_back(normal / normal.norm());
    constexpr unsigned int max_halvings = 14;
    const double farthest = 1.01 * (contacts.diameters[of.first] + contacts.diameters[of.second]);
    double       shortest = farthest;
    SpaceVector3 way;
    for (const SpaceVector3 &direction : directions)
    {
      if (overlap(moved, stays, shortest * direction))
        continue;
      double low = 0.;
      for (unsigned int halving = 0; halving < max_halvings; ++halving)
      {
        const double middle                                          = 0.5 * (low + shortest);
        (overlap(moved, stays, middle * direction) ? low : shortest) = middle;
      }
      way = shortest * direction;
    }
    return { way, 0.5 * (moved.around.low + moved.around.high) };
  }
} // namespace Exemplar
