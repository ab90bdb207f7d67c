// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_search_h
#define exemplar_contact_search_h

#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/contact_surface.h>
#include <exemplar/obstacles/obstacles.h>
#include <exemplar/potential/touch.h>

#include <vector>

namespace Exemplar
{
  /// What of the body meets what of an obstacle.
  enum class PairKind
  {
    node_half_space,
    node_box,
    node_triangle,
    node_edge,
    edge_edge,
    triangle_point
  };

  /// A part of the body and a part of an obstacle, by their numbers.
  struct ContactPair
  {
    PairKind     kind;
    unsigned int of_body, of_obstacle;
    unsigned int flat_part = of_obstacle; ///< of a triangle: see ObstacleShape

    /// With all triangles of a flat part a node is one pair.
    PairKey
    key() const
    {
      return static_cast<PairKey>(kind) << 61U | static_cast<PairKey>(of_body) << 32U | flat_part;
    }
  };

  /// An obstacle where it stands at some time.
  struct StandingObstacle
  {
    explicit StandingObstacle(const Obstacle &obstacle) : obstacle(&obstacle) {}

    /// Let it stand where it is at this time [s].
    void
    move_to(double time);

    const ObstacleShape &
    shape() const
    {
      return obstacle->shape();
    }

    const Obstacle           *obstacle;
    ObstaclePose              pose;
    std::vector<SpaceVector3> vertices; ///< in its axes [m]
    BoxTree                   points, edges, triangles;
    AxisBox                   around; ///< all of it but half spaces, with its radius, in its axes
    unsigned int              version = 0; ///< of the obstacle, of which vertices and trees are
    unsigned int              n_moves = 0; ///< of its vertices in its axes
  };

  /// The pairs that were within reach when they were looked for last, in an order that mesh and obstacle decide. Until something has
  /// moved by what `reach` is more than asked for, all that are asked for are among them.
  struct KeptPairs
  {
    std::vector<ContactPair> pairs;
    Places                   places;       ///< of the body's nodes then
    double                   reach   = 0.; ///< [m]
    unsigned int             n_moves = 0;  ///< of the obstacle's vertices until then
  };

  /// The body's nodes of a pair, and their places in the obstacle's axes [m].
  struct PairCorners
  {
    unsigned int                n = 0;
    std::array<unsigned int, 3> nodes{};
    std::array<SpaceVector3, 3> places;
  };

  /// A part of the body and a part of an obstacle that are nearer than their width, in space.
  struct Contact : Touch
  {
    ContactPair  pair;
    SpaceVector3 of_obstacle; ///< the obstacle's point [m]
  };

  /// The pairs of a body and an obstacle.
  class ContactSearch
  {
  public:
    /// All must outlive it. `number` is the obstacle's. Searches of the same obstacle and surface may share what is kept; null: nothing is.
    ContactSearch(const ContactSurface   &surface,
                  const Obstacles        &obstacles,
                  const StandingObstacle &standing,
                  unsigned int            number,
                  KeptPairs              *kept = nullptr)
        : surface(surface), obstacles(obstacles), standing(standing), number(number), kept(kept),
          widest(standing.shape().radius + surface.greatest_offset())
    {
    }

    /// Append the pairs with d < range times their width, in an order that mesh and obstacle decide.
    void
    append(const Vector &positions, double range, std::vector<Contact> &contacts) const;

    /// Call visit(pair, distance) for all pairs that may be nearer than `reach` [m], and maybe for others.
    template <typename Visit>
    void
    visit_near(const Vector &positions, double reach, const Visit &visit) const;

    /// The part of a displacement of the nodes that goes at most nine tenths of the way to the obstacle, which stands.
    double
    max_step(const Vector &positions, const Vector &displacement) const;

    /// The same while the obstacle goes on to where it is at this time [s], of a way in its axes; at most as much as it turns
    /// by five degrees.
    double
    max_step_to(double time, const Vector &positions, const Vector &displacement) const;

    /// Append the pairs that meet while nodes go straight from positions to others, in the obstacle's axes, and the obstacle goes on to where it is at this
    /// time [s]: with the distance at the end from the plane of the place where they meet, negative there. Half spaces do not
    /// count: their distance has a sign everywhere.
    void
    append_meeting(double                time,
                   const Vector         &from,
                   const Vector         &to,
                   std::vector<Contact> &contacts) const;

    PairCorners
    corners(const ContactPair &pair, const Places &places) const;

    /// With the body's nodes at these places in the obstacle's axes; in these axes.
    PairDistance
    distance(const ContactPair &pair, const std::array<SpaceVector3, 3> &places) const;

    /// The width from which a pair pushes [m].
    double
    width(const ContactPair &pair) const;

    /// One of the body's nodes of a pair.
    unsigned int
    node_of(const ContactPair &pair) const;

  private:
    /// With the obstacle's axes there.
    Places
    places_of(const Vector &positions, const ObstaclePose &pose) const;

    Places
    places_of(const Vector &positions) const
    {
      return places_of(positions, standing.pose);
    }

    /// How far the obstacle's vertices go in its axes until this time [s]; empty where it does not deform.
    std::vector<SpaceVector3>
    own_ways(double time) const;

    /// How far its nearest point does.
    SpaceVector3
    own_way_of(const ContactPair               &pair,
               const Nearest                   &nearest,
               const std::vector<SpaceVector3> &ways) const;

    /// The part of the way from `places` to `ends` that may be gone beside an obstacle whose vertices go `own_way` [m] in its axes, at
    /// most; `longest` at most.
    double
    max_step(const Places &places, const Places &ends, double own_way, double longest) const;

    /// Call visit(pair) for all pairs whose boxes, on the way from `places` to `ends`, are nearer than `reach`.
    template <typename Visit>
    void
    visit_candidates(const Places &places,
                     const Places &ends,
                     double        reach,
                     const Visit  &visit) const;

    /// The same, without what is kept.
    template <typename Visit>
    void
    search(const Places &places, const Places &ends, double reach, const Visit &visit) const;

    /// Whether all of these are among the kept pairs, which may be found anew for that.
    bool
    keep(const Places &places, const Places &ends, double reach) const;

    /// How far the surface's nodes are apart along an axis, at most [m].
    double
    farthest(const Places &places, const Places &others) const;

    AxisBox
    box_of_obstacle(const ContactPair &pair) const;

    /// How far beneath what meets the obstacle the part of the body is [m].
    double
    offset_of(const ContactPair &pair) const;

    /// Of both parts of a pair, in the obstacle's axes [m].
    double
    greatest_coordinate(const ContactPair &pair, const PairCorners &x) const;

    /// The distance of a pair with a half space [m].
    double
    height(const ContactPair &pair, const SpaceVector3 &place) const;

    Nearest
    nearest_of(const ContactPair &pair, const std::array<SpaceVector3, 3> &places) const;

    Contact
    contact(const ContactPair &pair, const PairCorners &corners, const PairDistance &at) const;

    /// Append a contact; of a node with a flat part the nearest one alone, so that a seam within it does not push twice.
    static void
    append_nearest(Contact contact, std::vector<Contact> &contacts);

    /// `longest`, or less, for n nodes that go these ways, and the obstacle's vertices one of that length.
    double
    max_step(const ContactPair                 &pair,
             const std::array<SpaceVector3, 3> &places,
             const std::array<SpaceVector3, 3> &ways,
             unsigned int                       n,
             double                             own_way,
             double                             longest) const;

    const ContactSurface   &surface;
    const Obstacles        &obstacles;
    const StandingObstacle &standing;
    const unsigned int      number;
    KeptPairs *const        kept;
    const double            widest; ///< of the obstacle's radius and the body's offset together [m]
  };

  template <typename Visit>
  void
  ContactSearch::visit_candidates(const Places &places,
                                  const Places &ends,
                                  const double  reach,
                                  const Visit  &visit) const
  {
    if (kept == nullptr || !keep(places, ends, reach))
    {
      search(places, ends, reach, visit);
      return;
    }
    for (const ContactPair &pair : kept->pairs)
    {
      AxisBox           box;
      const PairCorners x = corners(pair, places);
      for (unsigned int i = 0; i < x.n; ++i)
      {
        box.add(x.places[i]);
        box.add(ends[x.nodes[i]]);
      }
      if (box.widened(reach + widest).meets(box_of_obstacle(pair)))
        visit(pair);
    }
  }

  template <typename Visit>
  void
  ContactSearch::search(const Places &places,
                        const Places &ends,
                        const double  reach,
                        const Visit  &visit) const
  {
    const ObstacleShape &shape  = standing.shape();
    const double         wide   = reach + widest;
    const auto           box_of = [&](const auto &nodes)
    {
      AxisBox box;
      for (const unsigned int node : nodes)
      {
        box.add(places[node]);
        box.add(ends[node]);
      }
      return box.widened(wide);
    };
    const bool meets_nodes
        = shape.half_sizes.has_value() || shape.is_surface() || shape.edges_meet_nodes();
    for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    {
      for (unsigned int h = 0; h < shape.half_spaces.size(); ++h)
        visit(ContactPair{ PairKind::node_half_space, i, h });
      if (!meets_nodes)
        continue;
      const AxisBox box = box_of(std::array<unsigned int, 1>{ { surface.nodes[i].node } });
      if (!box.meets(standing.around))
        continue;
      if (shape.half_sizes)
        visit(ContactPair{ PairKind::node_box, i, 0 });
      standing.triangles.visit(
          box,
          [&](const unsigned int t) {
            visit(ContactPair{ PairKind::node_triangle, i, t, shape.flat_parts[t] });
          });
      if (shape.edges_meet_nodes())
        standing.edges.visit(box,
                             [&](const unsigned int e) {
                               visit(ContactPair{ PairKind::node_edge, i, e });
                             });
    }
    for (unsigned int i = 0; i < surface.edges.size() && !standing.edges.empty(); ++i)
      if (const AxisBox box = box_of(surface.edges[i].nodes); box.meets(standing.around))
        standing.edges.visit(box,
                             [&](const unsigned int e) {
                               visit(ContactPair{ PairKind::edge_edge, i, e });
                             });
    for (unsigned int i = 0; i < surface.triangles.size() && !standing.points.empty(); ++i)
      if (const AxisBox box = box_of(surface.triangles[i].nodes); box.meets(standing.around))
        standing.points.visit(box,
                              [&](const unsigned int p) {
                                visit(ContactPair{ PairKind::triangle_point, i, p });
                              });
  }

  template <typename Visit>
  void
  ContactSearch::visit_near(const Vector &positions, const double reach, const Visit &visit) const
  {
    const Places places = places_of(positions);
    visit_candidates(places, places, reach,
                     [&](const ContactPair &pair)
                     { visit(pair, distance(pair, corners(pair, places).places)); });
  }
} // namespace Exemplar

#endif
