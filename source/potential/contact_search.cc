// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/contact_search.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Of an obstacle in one go, so that its way in space is almost straight [rad].
    constexpr double greatest_turn_at_once = 0.0873;

    /// Widths by which more pairs are kept than are asked for, and up to which a search is kept at all.
    constexpr double skin = 1., greatest_kept_reach = 2.;
  } // namespace

  void
  StandingObstacle::move_to(const double time)
  {
    pose               = obstacle->pose(time);
    const bool is_made = !vertices.empty();
    if (is_made && !obstacle->deforms() && version == obstacle->version())
      return;
    version = obstacle->version();
    ++n_moves;
    vertices          = obstacle->vertices(time);
    around            = {};
    const auto box_of = [&](const auto &corners)
    {
      AxisBox box;
      for (const unsigned int v : corners)
        box.add(vertices[v]);
      around.add(box.widened(shape().radius));
      return box;
    };
    const auto update = [&](const auto &parts, BoxTree &tree)
    {
      std::vector<AxisBox> boxes;
      for (const auto &part : parts)
        boxes.push_back(box_of(part));
      if (is_made)
        tree.move(boxes);
      else
        tree = BoxTree(boxes);
    };
    std::vector<std::array<unsigned int, 1>> single;
    for (const unsigned int v : shape().points)
      single.push_back({ { v } });
    update(single, points);
    update(shape().edges, edges);
    update(shape().triangles, triangles);
  }

  Places
  ContactSearch::places_of(const Vector &positions, const ObstaclePose &pose) const
  {
    Places result(positions.size() / 3);
    for (const ContactSurface::Node &at : surface.nodes)
    {
      SpaceVector3 x;
      for (unsigned int c = 0; c < 3; ++c)
        x[c] = positions[3 * at.node + c];
      result[at.node] = pose.to_own(x);
    }
    return result;
  }

  namespace
  {
    /// The nearest point of a solid box, the origin in its middle; A is the given point.
    Nearest
    nearest_of_box(const SpaceVector3 &half_sizes, const SpaceVector3 &point)
    {
      Nearest result;
      result.a[0] = 1.;
      for (unsigned int c = 0; c < 3; ++c)
      {
        const double inside = std::clamp(point[c], -half_sizes[c], half_sizes[c]);
        result.way[c]       = point[c] - inside;
        if (inside == point[c] && result.n_free < 2)
          result.dv[result.n_free++][c] = 1.;
      }
      return result;
    }
  } // namespace

  PairCorners
  ContactSearch::corners(const ContactPair &pair, const Places &places) const
  {
    PairCorners result;
    const auto  take = [&](const auto &nodes)
    {
      for (const unsigned int node : nodes)
      {
        result.nodes[result.n]  = node;
        result.places[result.n] = places[node];
        ++result.n;
      }
    };
    if (pair.kind == PairKind::edge_edge)
      take(surface.edges[pair.of_body].nodes);
    else if (pair.kind == PairKind::triangle_point)
      take(surface.triangles[pair.of_body].nodes);
    else
      take(std::array<unsigned int, 1>{ { surface.nodes[pair.of_body].node } });
    return result;
  }

  Nearest
  ContactSearch::nearest_of(const ContactPair &pair, const std::array<SpaceVector3, 3> &x) const
  {
    const ObstacleShape &shape  = standing.shape();
    const auto           corner = [&](const unsigned int v) { return standing.vertices[v]; };
    const auto           edge   = [&]() -> std::array<SpaceVector3, 2>
    {
      const auto &e = shape.edges[pair.of_obstacle];
      return { { corner(e[0]), corner(e[1]) } };
    };
    switch (pair.kind)
    {
    case PairKind::node_box:
      return nearest_of_box(*shape.half_sizes, x[0]);
    case PairKind::node_triangle:
    {
      const auto &t = shape.triangles[pair.of_obstacle];
      return reversed(nearest({ { corner(t[0]), corner(t[1]), corner(t[2]) } }, x[0]));
    }
    case PairKind::node_edge:
    {
      Nearest result = nearest({ { x[0], x[0] } }, edge());
      result.a       = { { 1., 0., 0. } };
      return result;
    }
    case PairKind::edge_edge:
      return nearest({ { x[0], x[1] } }, edge());
    default:
      return nearest(x, corner(shape.points[pair.of_obstacle]));
    }
  }

  double
  ContactSearch::farthest(const Places &places, const Places &others) const
  {
    double result = 0.;
    for (const ContactSurface::Node &at : surface.nodes)
      for (unsigned int c = 0; c < 3; ++c)
        result = std::max(result, std::abs(places[at.node][c] - others[at.node][c]));
    return result;
  }

  bool
  ContactSearch::keep(const Places &places, const Places &ends, const double reach) const
  {
    if (standing.vertices.empty()) // half spaces are near all nodes
      return false;
    if (kept->n_moves == standing.n_moves && kept->places.size() == places.size()
        && reach + std::max(farthest(kept->places, places), farthest(kept->places, ends))
               <= kept->reach)
      return true;
    const double all_of_it = reach + farthest(places, ends);
    if (!(all_of_it <= greatest_kept_reach * obstacles.width))
      return false;
    kept->places  = places;
    kept->n_moves = standing.n_moves;
    kept->reach   = all_of_it + skin * obstacles.width;
    kept->pairs.clear();
    constexpr double more_than_rounding = 1. + 1e-6;
    search(places, places, more_than_rounding * kept->reach,
           [&](const ContactPair &pair) { kept->pairs.push_back(pair); });
    return true;
  }

  AxisBox
  ContactSearch::box_of_obstacle(const ContactPair &pair) const
  {
    const ObstacleShape &shape = standing.shape();
    AxisBox              box;
    const auto           add = [&](const auto &part)
    {
      for (const unsigned int v : part)
        box.add(standing.vertices[v]);
    };
    if (pair.kind == PairKind::node_box)
      return standing.around;
    if (pair.kind == PairKind::node_triangle)
      add(shape.triangles[pair.of_obstacle]);
    else if (pair.kind == PairKind::triangle_point)
      box.add(standing.vertices[shape.points[pair.of_obstacle]]);
    else
      add(shape.edges[pair.of_obstacle]);
    return box;
  }

  double
  ContactSearch::offset_of(const ContactPair &pair) const
  {
    if (pair.kind == PairKind::edge_edge)
      return surface.edges[pair.of_body].offset;
    if (pair.kind == PairKind::triangle_point)
      return surface.triangles[pair.of_body].offset;
    return surface.nodes[pair.of_body].offset;
  }

  double
  ContactSearch::height(const ContactPair &pair, const SpaceVector3 &place) const
  {
    const auto &half_space = standing.shape().half_spaces[pair.of_obstacle];
    return half_space.normal * place - half_space.offset - offset_of(pair);
  }

  PairDistance
  ContactSearch::distance(const ContactPair &pair, const std::array<SpaceVector3, 3> &x) const
  {
    PairDistance at;
    if (pair.kind == PairKind::node_half_space)
    {
      at.nearest.a[0] = 1.;
      at.normal       = standing.shape().half_spaces[pair.of_obstacle].normal;
      at.distance     = height(pair, x[0]);
      at.is_flat      = true;
      return at;
    }
    at.nearest          = nearest_of(pair, x);
    const double length = at.nearest.way.norm();
    at.distance         = length - standing.shape().radius - offset_of(pair);
    if (length > 0.)
      at.normal = at.nearest.way / length;
    return at;
  }

  double
  ContactSearch::width(const ContactPair &pair) const
  {
    const StartWidth *own = obstacles.own_width(number, pair.key());
    return own == nullptr ? obstacles.widths.at(node_of(pair)) : own->width;
  }

  unsigned int
  ContactSearch::node_of(const ContactPair &pair) const
  {
    if (pair.kind == PairKind::edge_edge)
      return surface.edges[pair.of_body].nodes[0];
    if (pair.kind == PairKind::triangle_point)
      return surface.triangles[pair.of_body].nodes[0];
    return surface.nodes[pair.of_body].node;
  }

  double
  ContactSearch::greatest_coordinate(const ContactPair &pair, const PairCorners &x) const
  {
    AxisBox box;
    if (pair.kind != PairKind::node_half_space)
      box = box_of_obstacle(pair);
    for (unsigned int i = 0; i < x.n; ++i)
      box.add(x.places[i]);
    double result = 0.;
    for (unsigned int c = 0; c < 3; ++c)
      result = std::max({ result, std::abs(box.low[c]), std::abs(box.high[c]) });
    return result;
  }

  Contact
  ContactSearch::contact(const ContactPair  &pair,
                         const PairCorners  &x,
                         const PairDistance &at) const
  {
    Contact result;
    result.obstacle                   = number;
    result.pair                       = pair;
    result.at                         = at;
    double                      share = 0.;
    const dealii::Tensor<2, 3> &R     = standing.pose.rotation;
    if (pair.kind == PairKind::edge_edge)
    {
      const ContactSurface::Edge &edge = surface.edges[pair.of_body];
      share                            = edge.share;
      const auto        &other         = standing.shape().edges[pair.of_obstacle];
      const SpaceVector3 e             = R * (x.places[1] - x.places[0]);
      const SpaceVector3 f = R * (standing.vertices[other[1]] - standing.vertices[other[0]]);
      result.part          = edge_part(e, f, edge.square, f.norm_square());
    }
    else if (pair.kind == PairKind::triangle_point)
      share = surface.triangles[pair.of_body].share;
    else
      share = surface.nodes[pair.of_body].share;
    result.full_stiffness = contact_stiffness_factor * share;
    result.at.normal      = R * at.normal;
    result.at.nearest.way = R * at.nearest.way;
    for (unsigned int k = 0; k < at.nearest.n_free; ++k)
      result.at.nearest.dv[k] = R * at.nearest.dv[k];
    Gap &gap        = result.gap;
    gap.n_nodes     = x.n;
    gap.normal      = result.at.normal;
    gap.distance    = at.distance;
    gap.stiffness   = result.part.m * result.full_stiffness;
    gap.width       = width(pair);
    gap.coordinates = greatest_coordinate(pair, x);
    SpaceVector3 point;
    for (unsigned int i = 0; i < x.n; ++i)
    {
      gap.nodes[i]        = x.nodes[i];
      gap.coefficients[i] = at.nearest.a[i];
      for (unsigned int k = 0; k < 2; ++k)
        result.by_free[k][i] = at.nearest.da[k][i];
      point += at.nearest.a[i] * x.places[i];
    }
    result.of_obstacle
        = standing.pose.to_space(point - (at.distance + offset_of(pair)) * at.normal);
    return result;
  }

  void
  ContactSearch::append(const Vector         &positions,
                        const double          range,
                        std::vector<Contact> &contacts) const
  {
    const Places places = places_of(positions);
    visit_candidates(places, places, range * obstacles.width,
                     [&](const ContactPair &pair)
                     {
                       if (pair.kind == PairKind::node_half_space
                           && !(height(pair, places[surface.nodes[pair.of_body].node])
                                < range * obstacles.width))
                         return; // as most are
                       const PairCorners  x  = corners(pair, places);
                       const PairDistance at = distance(pair, x.places);
                       if (at.distance < range * width(pair))
                         append_nearest(contact(pair, x, at), contacts);
                     });
  }

  void
  ContactSearch::append_nearest(Contact contact, std::vector<Contact> &contacts)
  {
    // those of a node follow one another
    for (auto other = contacts.rbegin();
         other != contacts.rend() && other->obstacle == contact.obstacle
         && other->pair.kind == PairKind::node_triangle
         && other->pair.of_body == contact.pair.of_body
         && contact.pair.kind == PairKind::node_triangle;
         ++other)
      if (other->pair.flat_part == contact.pair.flat_part)
      {
        if (contact.gap.distance < other->gap.distance)
          *other = std::move(contact);
        return;
      }
    contacts.push_back(std::move(contact));
  }

  double
  ContactSearch::max_step(const ContactPair                 &pair,
                          const std::array<SpaceVector3, 3> &x,
                          const std::array<SpaceVector3, 3> &way,
                          const unsigned int                 n,
                          const double                       own_way,
                          const double                       longest) const
  {
    const PairDistance at   = distance(pair, x);
    const double       left = part_left * at.distance;
    if (at.is_flat)
    {
      const double towards = -(at.normal * way[0]);
      return towards * longest > at.distance - left ? std::max(0., (at.distance - left) / towards)
                                                    : longest;
    }
    double speed = 0.;
    for (unsigned int i = 0; i < n; ++i)
      speed = std::max(speed, way[i].norm());
    speed += own_way;
    return advance_to(at.distance, left, speed, longest,
                      [&](const double part)
                      {
                        std::array<SpaceVector3, 3> moved;
                        for (unsigned int i = 0; i < n; ++i)
                          moved[i] = x[i] + part * way[i];
                        return distance(pair, moved).distance - part * own_way;
                      });
  }

  namespace
  {
    std::array<SpaceVector3, 3>
    way_of(const PairCorners &x, const Places &ends)
    {
      std::array<SpaceVector3, 3> way;
      for (unsigned int i = 0; i < x.n; ++i)
        way[i] = ends[x.nodes[i]] - x.places[i];
      return way;
    }
  } // namespace

  double
  ContactSearch::max_step(const Places &places,
                          const Places &ends,
                          const double  own_way,
                          double        longest) const
  {
    // what ends near without meeting is bound as well
    visit_candidates(places, ends, own_way + part_left * obstacles.width,
                     [&](const ContactPair &pair)
                     {
                       const PairCorners x   = corners(pair, places);
                       const auto        way = way_of(x, ends);
                       longest               = max_step(pair, x.places, way, x.n, own_way, longest);
                     });
    return longest;
  }

  double
  ContactSearch::max_step(const Vector &positions, const Vector &displacement) const
  {
    Vector end = positions;
    end += displacement;
    // what lies beyond the displacement has not been looked at, but half spaces know
    const double longest
        = standing.shape().vertices.empty() ? std::numeric_limits<double>::infinity() : 1.;
    return max_step(places_of(positions), places_of(end), 0., longest);
  }

  std::vector<SpaceVector3>
  ContactSearch::own_ways(const double time) const
  {
    if (!standing.obstacle->deforms())
      return {};
    std::vector<SpaceVector3> result = standing.obstacle->vertices(time);
    for (std::size_t v = 0; v < result.size(); ++v)
      result[v] -= standing.vertices[v];
    return result;
  }

  namespace
  {
    double
    longest_of(const std::vector<SpaceVector3> &ways)
    {
      double result = 0.;
      for (const SpaceVector3 &way : ways)
        result = std::max(result, way.norm());
      return result;
    }
  } // namespace

  double
  ContactSearch::max_step_to(const double  time,
                             const Vector &positions,
                             const Vector &displacement) const
  {
    Vector end = positions;
    end += displacement;
    const ObstaclePose pose = standing.obstacle->pose(time);
    const double       cosine
        = 0.5 * (trace(dealii::transpose(standing.pose.rotation) * pose.rotation) - 1.);
    const double turn = std::acos(std::clamp(cosine, -1., 1.));
    return max_step(places_of(positions), places_of(end, pose), longest_of(own_ways(time)),
                    turn > greatest_turn_at_once ? greatest_turn_at_once / turn : 1.);
  }

  SpaceVector3
  ContactSearch::own_way_of(const ContactPair               &pair,
                            const Nearest                   &nearest,
                            const std::vector<SpaceVector3> &ways) const
  {
    SpaceVector3 result;
    if (ways.empty())
      return result;
    const ObstacleShape &shape = standing.shape();
    const auto           add   = [&](const auto &part)
    {
      for (std::size_t j = 0; j < part.size(); ++j)
        result += nearest.b[j] * ways[part[j]];
    };
    if (pair.kind == PairKind::node_triangle)
      add(shape.triangles[pair.of_obstacle]);
    else if (pair.kind == PairKind::triangle_point)
      result = ways[shape.points[pair.of_obstacle]];
    else
      add(shape.edges[pair.of_obstacle]);
    return result;
  }

  void
  ContactSearch::append_meeting(const double          time,
                                const Vector         &from,
                                const Vector         &to,
                                std::vector<Contact> &contacts) const
  {
    if (standing.shape().vertices.empty())
      return;
    const ObstaclePose              pose   = standing.obstacle->pose(time);
    const Places                    places = places_of(from), ends = places_of(to, pose);
    const std::vector<SpaceVector3> of_obstacle = own_ways(time);
    const double                    own_way     = longest_of(of_obstacle);
    const dealii::Tensor<2, 3> turn = pose.rotation * dealii::transpose(standing.pose.rotation);
    visit_candidates(places, ends, own_way + part_left * obstacles.width,
                     [&](const ContactPair &pair)
                     {
                       PairCorners  x    = corners(pair, places);
                       const auto   way  = way_of(x, ends);
                       const double part = max_step(pair, x.places, way, x.n, own_way, 1.);
                       if (!(part < 1.))
                         return;
                       for (unsigned int i = 0; i < x.n; ++i)
                         x.places[i] += part * way[i];
                       const PairDistance at = distance(pair, x.places);
                       // what is left of the way, less all of that of the obstacle, which has stood
                       SpaceVector3 left = -own_way_of(pair, at.nearest, of_obstacle);
                       for (unsigned int i = 0; i < x.n; ++i)
                         left += (1. - part) * at.nearest.a[i] * way[i];
                       contacts.push_back(contact(pair, x, at));
                       Gap &gap = contacts.back().gap;
                       gap.distance += at.normal * left;
                       gap.normal = turn * gap.normal;
                     });
  }
} // namespace Exemplar
