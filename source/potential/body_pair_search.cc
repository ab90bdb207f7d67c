// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/body_pair_search.h>
#include <exemplar/potential/nodal_vectors.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Widths by which more pairs are kept than are asked for, and up to which a search is kept at all: a surface has many pairs with
    /// itself.
    constexpr double skin_of_body = 0.5, greatest_kept_reach_of_body = 2.,
                     greatest_kept_reach_of_bodies = 4.;
    constexpr double more_than_rounding            = 1. + 1e-6;

    /// How far the points of the one side of a pair go beside those of the other, at most [m].
    double
    way_of_pair(const BodyPairCorners &x, const std::array<SpaceVector3, 4> &ways)
    {
      const SpaceVector3    mean = 0.25 * (ways[0] + ways[1] + ways[2] + ways[3]);
      std::array<double, 2> fastest{};
      for (unsigned int i = 0; i < 4; ++i)
      {
        double &of_side = fastest[i < x.n_of_first ? 0 : 1];
        of_side         = std::max(of_side, (ways[i] - mean).norm());
      }
      return fastest[0] + fastest[1];
    }

    std::array<SpaceVector3, 4>
    ways_of(const BodyPairCorners &x, const Places &ends)
    {
      std::array<SpaceVector3, 4> ways;
      for (unsigned int i = 0; i < 4; ++i)
        ways[i] = ends[x.nodes[i]] - x.places[i];
      return ways;
    }
  } // namespace

  Places
  BodyPairSearch::places_of(const Vector &positions) const
  {
    Places result(positions.size() / 3);
    for (const ContactSurface::Node &at : surface.nodes)
      result[at.node] = contacts.points.value(positions, at.node);
    return result;
  }

  std::vector<KeptBodyPairs::Candidate>
  BodyPairSearch::search(const Places &places, const Places &ends, const double reach) const
  {
    std::vector<KeptBodyPairs::Candidate> found;
    const auto                            add = [&](const BodyPair &pair)
    {
      if (!contacts.may_meet(surface, pair))
        return;
      if (const double width = contacts.width_of(surface, pair); width > 0.)
        found.push_back({ pair, width, 0. });
    };
    if (!kept.near)
      kept.near.emplace(surface, contacts.pieces, places);
    kept.near->move(places, ends, reach);
    kept.near->visit(contacts.also_self, add);
    std::sort(found.begin(), found.end(),
              [](const auto &a, const auto &b) { return a.pair.key() < b.pair.key(); });
    return found;
  }

  double
  BodyPairSearch::farthest_apart(const Places &places, const Places &others) const
  {
    AxisBox ways;
    for (const ContactSurface::Node &at : surface.nodes)
      ways.add(others[at.node] - places[at.node]);
    return (ways.high - ways.low).norm();
  }

  std::optional<double>
  BodyPairSearch::keep(const Places &places, const Places &ends, const double reach) const
  {
    if (kept.places.size() == places.size())
    {
      const double apart
          = std::max(farthest_apart(kept.places, places), farthest_apart(kept.places, ends));
      if (reach + apart <= kept.reach)
        return apart;
    }
    const double apart = farthest_apart(places, ends);
    const double most
        = contacts.also_self ? greatest_kept_reach_of_body : greatest_kept_reach_of_bodies;
    if (!(reach + apart <= most * contacts.width))
      return {};
    kept.places     = places;
    kept.reach      = reach + apart + skin_of_body * contacts.width;
    kept.candidates = search(places, places, more_than_rounding * kept.reach);
    for (KeptBodyPairs::Candidate &candidate : kept.candidates)
      candidate.distance
          = distance(candidate.pair, corners(candidate.pair, places).places).distance;
    return apart;
  }

  template <typename Visit>
  void
  BodyPairSearch::visit_candidates(const Places &places,
                                   const Places &ends,
                                   const double  reach,
                                   const Visit  &visit) const
  {
    const std::optional<double> apart = keep(places, ends, reach);
    if (!apart)
    {
      for (const KeptBodyPairs::Candidate &candidate : search(places, ends, reach))
        visit(candidate);
      return;
    }
    const double reach_then = more_than_rounding * (reach + *apart);
    for (const KeptBodyPairs::Candidate &candidate : kept.candidates)
    {
      if (candidate.distance > reach_then)
        continue;
      const BodyPairCorners x = corners(candidate.pair, places);
      AxisBox               first, second;
      for (unsigned int i = 0; i < 4; ++i)
      {
        AxisBox &box = i < x.n_of_first ? first : second;
        box.add(x.places[i]);
        box.add(ends[x.nodes[i]]);
      }
      if (first.widened(reach).meets(second))
        visit(candidate);
    }
  }

  Places
  BodyPairSearch::without_mean_way(const Places &places, Places ends) const
  {
    SpaceVector3 mean;
    for (const ContactSurface::Node &at : surface.nodes)
      mean += ends[at.node] - places[at.node];
    mean /= static_cast<double>(surface.nodes.size());
    for (const ContactSurface::Node &at : surface.nodes)
      ends[at.node] -= mean;
    return ends;
  }

  BodyPairCorners
  BodyPairSearch::corners(const BodyPair &pair, const Places &places) const
  {
    BodyPairCorners result;
    unsigned int    n    = 0;
    const auto      take = [&](const auto &nodes)
    {
      for (const unsigned int node : nodes)
      {
        result.nodes[n]  = node;
        result.places[n] = places[node];
        ++n;
      }
    };
    if (pair.kind == BodyPairKind::edge_edge)
    {
      take(surface.edges[pair.first].nodes);
      result.n_of_first = n;
      take(surface.edges[pair.second].nodes);
    }
    else
    {
      take(surface.triangles[pair.second].nodes);
      result.n_of_first = n;
      take(std::array<unsigned int, 1>{ { surface.nodes[pair.first].node } });
    }
    return result;
  }

  PairDistance
  BodyPairSearch::distance(const BodyPair &pair, const std::array<SpaceVector3, 4> &x) const
  {
    PairDistance at;
    if (pair.kind == BodyPairKind::edge_edge)
      at.nearest = nearest(std::array<SpaceVector3, 2>{ { x[0], x[1] } }, { { x[2], x[3] } });
    else
      at.nearest = nearest(std::array<SpaceVector3, 3>{ { x[0], x[1], x[2] } }, x[3]);
    at.distance = at.nearest.way.norm();
    if (at.distance > 0.)
      at.normal = at.nearest.way / at.distance;
    return at;
  }

  double
  BodyPairSearch::full_stiffness(const BodyPair &pair) const
  {
    // the softer side's modulus and the lesser side's area
    const auto of_both = [](const auto &a, const auto &b)
    { return std::min(a.share / a.area, b.share / b.area) * std::min(a.area, b.area); };
    return contact_stiffness_factor
           * (pair.kind == BodyPairKind::edge_edge
                  ? of_both(surface.edges[pair.first], surface.edges[pair.second])
                  : of_both(surface.nodes[pair.first], surface.triangles[pair.second]));
  }

  BodyTouch
  BodyPairSearch::touch(const KeptBodyPairs::Candidate &candidate,
                        const BodyPairCorners          &x,
                        const PairDistance             &at) const
  {
    BodyTouch result;
    result.pair           = candidate.pair;
    result.at             = at;
    result.full_stiffness = full_stiffness(candidate.pair);
    if (candidate.pair.kind == BodyPairKind::edge_edge)
      result.part = edge_part(x.places[1] - x.places[0], x.places[3] - x.places[2],
                              surface.edges[candidate.pair.first].square,
                              surface.edges[candidate.pair.second].square);
    Gap &gap      = result.gap;
    gap.n_nodes   = 4;
    gap.normal    = at.normal;
    gap.distance  = at.distance;
    gap.stiffness = result.part.m * result.full_stiffness;
    gap.width     = candidate.width;
    for (unsigned int i = 0; i < 4; ++i)
    {
      gap.nodes[i]                = x.nodes[i];
      const bool         is_first = i < x.n_of_first;
      const unsigned int own      = is_first ? i : i - x.n_of_first;
      gap.coefficients[i]         = is_first ? at.nearest.a[own] : -at.nearest.b[own];
      for (unsigned int k = 0; k < 2; ++k)
        result.by_free[k][i] = is_first ? at.nearest.da[k][own] : -at.nearest.db[k][own];
    }
    return result;
  }

  BodyTouch
  BodyPairSearch::touch_at(const BodyPair &pair, const Places &places) const
  {
    const BodyPairCorners x = corners(pair, places);
    return touch({ pair, contacts.width_of(surface, pair), 0. }, x, distance(pair, x.places));
  }

  void
  BodyPairSearch::append(const Vector           &positions,
                         const double            range,
                         std::vector<BodyTouch> &touches) const
  {
    const Places places = places_of(positions);
    visit_candidates(places, places, range * contacts.width,
                     [&](const KeptBodyPairs::Candidate &candidate)
                     {
                       const BodyPairCorners x  = corners(candidate.pair, places);
                       const PairDistance    at = distance(candidate.pair, x.places);
                       if (at.distance < range * candidate.width)
                         touches.push_back(touch(candidate, x, at));
                     });
  }

  void
  BodyPairSearch::append_along(const Vector           &positions,
                               const Vector           &displacement,
                               const double            reach,
                               std::vector<BodyTouch> &touches) const
  {
    Vector end = positions;
    end += displacement;
    const Places places = places_of(positions);
    Places       ends   = without_mean_way(places, places_of(end));
    if (const double apart = farthest_apart(places, ends); apart > reach)
      for (const ContactSurface::Node &at : surface.nodes)
        ends[at.node] = places[at.node] + reach / apart * (ends[at.node] - places[at.node]);
    visit_candidates(places, ends, contacts.width,
                     [&](const KeptBodyPairs::Candidate &candidate)
                     {
                       const BodyPairCorners x  = corners(candidate.pair, places);
                       const PairDistance    at = distance(candidate.pair, x.places);
                       if (at.distance < candidate.width + way_of_pair(x, ways_of(x, ends)))
                         touches.push_back(touch(candidate, x, at));
                     });
  }

  double
  BodyPairSearch::max_step(const BodyPair                    &pair,
                           const BodyPairCorners             &x,
                           const std::array<SpaceVector3, 4> &ways,
                           const double                       longest) const
  {
    const SpaceVector3 mean = 0.25 * (ways[0] + ways[1] + ways[2] + ways[3]);
    const double       now  = distance(pair, x.places).distance;
    return advance_to(now, part_left * now, way_of_pair(x, ways), longest,
                      [&](const double part)
                      {
                        std::array<SpaceVector3, 4> moved;
                        for (unsigned int i = 0; i < 4; ++i)
                          moved[i] = x.places[i] + part * (ways[i] - mean);
                        return distance(pair, moved).distance;
                      });
  }

  BodyPairSearch::Limit
  BodyPairSearch::max_step(const Vector &positions, const Vector &displacement) const
  {
    Vector end = positions;
    end += displacement;
    const Places places = places_of(positions), ends = without_mean_way(places, places_of(end));
    Limit        limit;
    const auto   bound = [&](const KeptBodyPairs::Candidate &candidate)
    {
      const BodyPairCorners x    = corners(candidate.pair, places);
      const double          part = max_step(candidate.pair, x, ways_of(x, ends), limit.part);
      if (part < limit.part)
        limit = { part, true, x.places[3] };
    };
    // what was near bounds a long way to one of which all pairs are soon found; the least part of all is the same in any order
    Places reached = ends;
    if (kept.places.size() == places.size()
        && farthest_apart(places, ends) > greatest_kept_reach_of_bodies * contacts.width)
    {
      for (const KeptBodyPairs::Candidate &candidate : kept.candidates)
        bound(candidate);
      for (const ContactSurface::Node &at : surface.nodes)
        reached[at.node] = places[at.node] + limit.part * (ends[at.node] - places[at.node]);
    }
    // what ends near without meeting is bound as well
    visit_candidates(places, reached, part_left * contacts.width, bound);
    return limit;
  }

  void
  BodyPairSearch::append_meeting(const Vector           &from,
                                 const Vector           &to,
                                 std::vector<BodyTouch> &touches) const
  {
    const Places places = places_of(from), ends = without_mean_way(places, places_of(to));
    visit_candidates(places, ends, part_left * contacts.width,
                     [&](const KeptBodyPairs::Candidate &candidate)
                     {
                       BodyPairCorners x    = corners(candidate.pair, places);
                       const auto      ways = ways_of(x, ends);
                       const double    part = max_step(candidate.pair, x, ways, 1.);
                       if (!(part < 1.))
                         return;
                       for (unsigned int i = 0; i < 4; ++i)
                         x.places[i] += part * ways[i];
                       touches.push_back(touch(candidate, x, distance(candidate.pair, x.places)));
                       Gap &gap = touches.back().gap;
                       for (unsigned int i = 0; i < 4; ++i)
                         gap.distance += (1. - part) * gap.coefficients[i] * (gap.normal * ways[i]);
                     });
  }
} // namespace Exemplar
