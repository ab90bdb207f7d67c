// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_touch_h
#define exemplar_touch_h

#include <exemplar/obstacles/closest_features.h>
#include <exemplar/potential/gap.h>

#include <vector>

namespace Exemplar
{
  /// Places of nodes, in space or in an obstacle's axes, by node; only those of the surface are set.
  using Places = std::vector<SpaceVector3>;

  /// c in k = c E A, doc/contact.md.
  constexpr double contact_stiffness_factor = 0.1;

  /// The part of a gap that a step leaves, at least.
  constexpr double part_left = 0.1;

  /// Where a pair is nearest.
  struct PairDistance
  {
    Nearest      nearest;
    SpaceVector3 normal;           ///< gradient by the first part's point; 0 where there is none
    double       distance = 0.;    ///< less the radius [m]
    bool         is_flat  = false; ///< a half space: the distance has no second derivative
  };

  /// The part m of the energy that two edges have, with its derivatives by their vectors e and f: 1 unless they are almost parallel.
  struct EdgePart
  {
    double                                             m = 1.;
    std::array<SpaceVector3, 2>                        by;    ///< dm/de and dm/df [1/m]
    std::array<std::array<dealii::Tensor<2, 3>, 2>, 2> twice; ///< second derivatives [1/m^2]
  };

  /// The part of edges of which the squares of the lengths at rest [m^2] are these.
  EdgePart
  edge_part(const SpaceVector3 &e, const SpaceVector3 &f, double e_square, double f_square);

  /// Two parts of surfaces that are nearer than their width, and what their barrier needs. Where both parts are of the body, nodes and
  /// coefficients of the gap are those of the one and then of the other.
  struct Touch
  {
    Gap          gap;            ///< its stiffness is m times the full one
    PairDistance at;             ///< in space
    double       full_stiffness; ///< k [N]
    EdgePart
        part; ///< of edges: nodes 0 and 1 are the ends of e and, if f is of the body, 2 and 3 those of f
    /// Derivatives of the coefficients by the free parameters.
    std::array<std::array<double, 4>, 2> by_free{};
    unsigned int obstacle = 0; ///< its number, if both parts are not of the body
  };

  /// The part of a way that is gone so that a distance stays above `left`; `longest` at most. No point of the pair goes faster than
  /// `speed` beside the other [m a way], so that nothing is met on a way that is shorter than the distance (additive advancement).
  /// `distance_at` tells the distance after a part of the way.
  template <typename DistanceAt>
  double
  advance_to(const double      distance,
             const double      left,
             const double      speed,
             const double      longest,
             const DistanceAt &distance_at)
  {
    // which takes 157 to 314 rounds at most in random pairs
    constexpr unsigned int max_advances = 1000;
    if (!(speed * longest > distance - left))
      return longest;
    if (!(distance > 0.))
      return 0.;
    double part = (distance - left) / speed, tried = part;
    for (unsigned int round = 0; round < max_advances; ++round)
    {
      tried            = tried < longest ? tried : longest;
      const double now = distance_at(tried);
      if (!(now >= left) || tried == longest)
        return now >= left ? longest : part;
      part  = tried;
      tried = part + (1. - part_left) * now / speed;
    }
    return part;
  }
} // namespace Exemplar

#endif
