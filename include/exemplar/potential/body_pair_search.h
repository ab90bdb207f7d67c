// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_pair_search_h
#define exemplar_body_pair_search_h

#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/body_contacts.h>
#include <exemplar/obstacles/surface_pairs.h>
#include <exemplar/potential/touch.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  /// Two parts of the body that are nearer than their width.
  struct BodyTouch : Touch
  {
    BodyPair pair;
  };

  /// The pairs that were within reach when they were looked for last, in the order of their keys. Until places have changed beside
  /// each other by what `reach` is more than asked for, all that are asked for are among them.
  struct KeptBodyPairs
  {
    /// A pair that was near, and from where it pushes.
    struct Candidate
    {
      BodyPair pair;
      double   width;         ///< from where it pushes [m]
      double   distance = 0.; ///< then [m]
    };

    std::vector<Candidate>      candidates;
    Places                      places;     ///< of the nodes then; empty: nothing is kept
    double                      reach = 0.; ///< [m]
    std::optional<SurfacePairs> near;       ///< since the first search

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      return candidates.capacity() * sizeof(Candidate) + places.capacity() * sizeof(SpaceVector3)
             + (near ? near->memory_consumption() : 0);
    }
  };

  /// The four nodes of a pair, those of the triangle or of the first edge before the others, and their places [m].
  struct BodyPairCorners
  {
    unsigned int                n_of_first;
    std::array<unsigned int, 4> nodes;
    std::array<SpaceVector3, 4> places;
  };

  /// The pairs of a body's surface with itself.
  class BodyPairSearch
  {
  public:
    /// All must outlive it. Searches of the same body may share what is kept.
    BodyPairSearch(const ContactSurface &surface, const BodyContacts &contacts, KeptBodyPairs &kept)
        : surface(surface), contacts(contacts), kept(kept)
    {
    }

    /// Append the pairs with d < range times their width, in the order of their keys.
    void
    append(const Vector &positions, double range, std::vector<BodyTouch> &touches) const;

    /// Append the pairs with d < width, and those that nodes may bring there that go as far beside each other as by this displacement, but
    /// not farther than `reach` [m].
    void
    append_along(const Vector           &positions,
                 const Vector           &displacement,
                 double                  reach,
                 std::vector<BodyTouch> &touches) const;

    /// How far a displacement may be gone.
    struct Limit
    {
      double       part   = 1.;    ///< of the displacement, which leaves a tenth of each distance
      bool         is_met = false; ///< whether a pair does not allow all of it
      SpaceVector3 place;          ///< of that pair, where the body is [m]
    };

    Limit
    max_step(const Vector &positions, const Vector &displacement) const;

    /// Append the pairs that meet while nodes go straight from positions to others: with the distance at the end along the normal of the
    /// place where they meet, negative there.
    void
    append_meeting(const Vector &from, const Vector &to, std::vector<BodyTouch> &touches) const;

    /// A pair where nodes are at these places.
    BodyTouch
    touch_at(const BodyPair &pair, const Places &places) const;

    BodyPairCorners
    corners(const BodyPair &pair, const Places &places) const;

    /// Of these corners.
    PairDistance
    distance(const BodyPair &pair, const std::array<SpaceVector3, 4> &x) const;

    /// All pairs that may meet whose boxes, on the way from `places` to `ends`, are nearer than `reach`, without those that are left
    /// out; in the order of their keys.
    std::vector<KeptBodyPairs::Candidate>
    search(const Places &places, const Places &ends, double reach) const;

    /// By node; only those of the surface are set.
    Places
    places_of(const Vector &positions) const;

  private:
    /// Call visit(candidate) for these, in this order, and maybe for others.
    template <typename Visit>
    void
    visit_candidates(const Places &places,
                     const Places &ends,
                     double        reach,
                     const Visit  &visit) const;

    /// Keep all of them, which may be found anew for that; by how much their distances on the way can be other than then [m]. Empty: they
    /// would be too many.
    std::optional<double>
    keep(const Places &places, const Places &ends, double reach) const;

    /// How far nodes have gone beside each other, at most [m].
    double
    farthest_apart(const Places &places, const Places &others) const;

    /// `ends` without the mean way from `places`, which changes no distance.
    Places
    without_mean_way(const Places &places, Places ends) const;

    /// `longest`, or less, for corners that go these ways.
    double
    max_step(const BodyPair                    &pair,
             const BodyPairCorners             &x,
             const std::array<SpaceVector3, 4> &ways,
             double                             longest) const;

    BodyTouch
    touch(const KeptBodyPairs::Candidate &candidate,
          const BodyPairCorners          &x,
          const PairDistance             &at) const;

    /// k without the part of almost parallel edges [N].
    double
    full_stiffness(const BodyPair &pair) const;

    const ContactSurface &surface;
    const BodyContacts   &contacts;
    KeptBodyPairs        &kept;
  };
} // namespace Exemplar

#endif
