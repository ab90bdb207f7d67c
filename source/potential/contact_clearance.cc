// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/solid_angle.h>
#include <exemplar/potential/contact_clearance.h>
#include <exemplar/potential/nodal_vectors.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    using Corners = std::array<SpaceVector3, 3>;

    /// The triangles of the body and of the obstacle in space, and the latter's edges.
    struct Geometry
    {
      std::vector<Corners>                     body, obstacle;
      std::vector<std::array<SpaceVector3, 2>> edges;
    };

    /// The faces of a solid box, outwards, by the numbers of its corners as in ObstacleShape.
    std::vector<std::array<unsigned int, 3>>
    faces_of_box()
    {
      std::vector<std::array<unsigned int, 3>> result;
      for (unsigned int c = 0; c < 3; ++c)
        for (const unsigned int side : { 0U, 1U })
        {
          const unsigned int a = 1U << (c + 1) % 3, b = 1U << (c + 2) % 3, at = side << c;
          const unsigned int second = side == 1 ? at + a : at + b;
          const unsigned int fourth = side == 1 ? at + b : at + a;
          result.push_back({ { at, second, at + a + b } });
          result.push_back({ { at, at + a + b, fourth } });
        }
      return result;
    }

    Geometry
    geometry_of(const ContactSurface   &body,
                const StandingObstacle &standing,
                const Vector           &positions)
    {
      Geometry   result;
      const auto own
          = [&](const unsigned int v) { return standing.pose.to_space(standing.vertices[v]); };
      for (const ContactSurface::Triangle &t : body.triangles)
        result.body.push_back({ { at_node(positions, t.nodes[0]), at_node(positions, t.nodes[1]),
                                  at_node(positions, t.nodes[2]) } });
      const ObstacleShape &shape = standing.shape();
      for (const auto &t : shape.half_sizes ? faces_of_box() : shape.triangles)
        result.obstacle.push_back({ { own(t[0]), own(t[1]), own(t[2]) } });
      for (const auto &e : shape.edges)
        result.edges.push_back({ { own(e[0]), own(e[1]) } });
      return result;
    }

    template <std::size_t n>
    AxisBox
    box_of(const std::array<SpaceVector3, n> &x)
    {
      AxisBox box;
      for (const SpaceVector3 &corner : x)
        box.add(corner);
      return box;
    }

    BoxTree
    tree_of(const std::vector<Corners> &triangles)
    {
      std::vector<AxisBox> boxes;
      for (const Corners &x : triangles)
        boxes.push_back(box_of(x));
      return BoxTree(boxes);
    }

    /// Whether an edge passes through one of the triangles; `where` gets its beginning.
    bool
    passes(const std::array<SpaceVector3, 2> &edge,
           const std::vector<Corners>        &triangles,
           const BoxTree                     &tree)
    {
      bool result = false;
      tree.visit(box_of(edge), [&](const unsigned int t)
                 { result = result || passes_through(edge, triangles[t]); });
      return result;
    }

    /// A place where surfaces pass through each other; empty if they do not.
    std::vector<SpaceVector3>
    crossing(const ContactSurface &body, const Vector &positions, const Geometry &geometry)
    {
      if (geometry.edges.empty())
        return {};
      const BoxTree of_body = tree_of(geometry.body), of_obstacle = tree_of(geometry.obstacle);
      for (const auto &edge : geometry.edges)
        if (passes(edge, geometry.body, of_body))
          return { 0.5 * (edge[0] + edge[1]) };
      for (const ContactSurface::Edge &edge : body.edges)
        if (const std::array<SpaceVector3, 2> x{
                { at_node(positions, edge.nodes[0]), at_node(positions, edge.nodes[1]) } };
            passes(x, geometry.obstacle, of_obstacle))
          return { 0.5 * (x[0] + x[1]) };
      return {};
    }

    /// Whether a point is inside of triangles that enclose something, of all processes together.
    bool
    is_inside(const SpaceVector3         &point,
              const std::vector<Corners> &triangles,
              const Exchange             *exchange)
    {
      double angle = 0.;
      for (const Corners &x : triangles)
        angle += solid_angle(point, x);
      if (exchange != nullptr)
        angle = exchange->sum(angle);
      return is_full_angle(angle);
    }

    /// A vector that one process knows, in all: that of the first process where `has` is true.
    SpaceVector3
    agreed(const Exchange &exchange, const bool has, const SpaceVector3 &own)
    {
      const double first = min_of_all(exchange, has ? exchange.process() : exchange.n_processes());
      std::array<double, 3> numbers{};
      for (unsigned int c = 0; c < 3 && has && exchange.process() == first; ++c)
        numbers[c] = own[c];
      exchange.sum(numbers.data(), 3);
      SpaceVector3 result;
      for (unsigned int c = 0; c < 3; ++c)
        result[c] = numbers[c];
      return result;
    }

    /// The outward normal of the body's triangles at its node.
    SpaceVector3
    normal_at(const unsigned int node, const ContactSurface &body, const Vector &positions)
    {
      SpaceVector3 n;
      for (const ContactSurface::Triangle &t : body.triangles)
        if (std::count(t.nodes.begin(), t.nodes.end(), node) > 0)
        {
          const SpaceVector3 x = at_node(positions, t.nodes[0]);
          n += dealii::cross_product_3d(at_node(positions, t.nodes[1]) - x,
                                        at_node(positions, t.nodes[2]) - x);
        }
      return n.norm() > 0. ? n / n.norm() : n;
    }
  } // namespace

  Clearance
  clearance(const ContactSurface   &body,
            const Obstacles        &obstacles,
            const StandingObstacle &standing,
            const unsigned int      number,
            const Vector           &positions,
            const double            reach,
            const Exchange         &exchange)
  {
    Clearance result;
    result.least = reach;
    const ContactSearch search(body, obstacles, standing, number);
    ContactPair         nearest_pair{};
    SpaceVector3        nearest_normal; // of the distance, in the obstacle's axes
    search.visit_near(positions, reach,
                      [&](const ContactPair &pair, const PairDistance &at)
                      {
                        result.pushes = result.pushes || at.distance < search.width(pair);
                        if (at.distance < result.least)
                        {
                          result.least   = at.distance;
                          nearest_pair   = pair;
                          nearest_normal = at.normal;
                        }
                      });
    const bool   is_near = result.least < reach;
    unsigned int node    = 0;
    if (is_near)
    {
      node            = search.node_of(nearest_pair);
      result.place    = at_node(positions, node);
      result.outwards = normal_at(node, body, positions);
      if (!body.has_inside())
      {
        result.is_either = nearest_normal.norm() == 0.;
        if (!result.is_either)
          result.outwards = -(standing.pose.rotation * nearest_normal);
      }
    }
    const double least  = min_of_all(exchange, result.least);
    const bool   is_own = is_near && result.least == least;
    result.least        = least;
    result.pushes       = exchange.any(result.pushes);
    if (obstacles.sizes.diameters.size() > 1)
    {
      SpaceVector3 piece;
      piece[0]     = obstacles.sizes.pieces[node];
      result.piece = static_cast<unsigned int>(agreed(exchange, is_own, piece)[0]);
    }

    const ObstacleShape &shape = standing.shape();
    const Geometry       geometry
        = shape.vertices.empty() ? Geometry() : geometry_of(body, standing, positions);
    const std::vector<SpaceVector3> crossed = crossing(body, positions, geometry);
    result.is_crossed                       = exchange.any(!crossed.empty());
    // place and normal are those of the nearest pair, if there is one
    result.outwards        = agreed(exchange, is_own, result.outwards);
    const bool knows_place = least < reach;
    result.place           = agreed(exchange, knows_place ? is_own : !crossed.empty(),
                          knows_place || crossed.empty() ? result.place : crossed[0]);
              if (result.is_crossed || shape.vertices.empty())
      return result;
    // nothing crosses: one is within the other as a whole, or not at all
    const SpaceVector3 of_obstacle = standing.pose.to_space(standing.vertices[0]);
    const bool         has_node    = !body.nodes.empty();
    const SpaceVector3 of_body     = agreed(
            exchange, has_node, has_node ? at_node(positions, body.nodes[0].node) : SpaceVector3());
    result.is_crossed = body.has_inside() && is_inside(of_obstacle, geometry.body, &exchange);
    if (!geometry.obstacle.empty() && (shape.is_closed || shape.half_sizes)
        && is_inside(of_body, geometry.obstacle, nullptr))
      result.is_crossed = true;
    if (result.is_crossed && !knows_place)
      result.place = of_body;
    return result;
  }
} // namespace Exemplar
