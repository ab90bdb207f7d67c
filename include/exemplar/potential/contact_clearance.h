// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_clearance_h
#define exemplar_contact_clearance_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/potential/contact_search.h>

namespace Exemplar
{
  /// How a body stands to an obstacle.
  struct Clearance
  {
    double least; ///< the least signed distance of a pair [m], at most the reach that was asked for
    SpaceVector3 place;     ///< of the body, where that is [m]
    unsigned int piece = 0; ///< of the body, of which that is
    /// Where the obstacle is from there: the unit normal of a solid, the way from a shell. A shell that touches with its middle, so
    /// that there is no way, has either normal.
    SpaceVector3 outwards;
    bool         is_either = false; ///< whether it has
    bool         is_crossed
        = false;         ///< whether surfaces pass through each other, or one is within the other
    bool pushes = false; ///< whether a pair is nearer than its width
  };

  /// Of the whole body, by all processes; `body` has the mesh's shares or none.
  Clearance
  clearance(const ContactSurface   &body,
            const Obstacles        &obstacles,
            const StandingObstacle &standing,
            unsigned int            number,
            const Vector           &positions,
            double                  reach,
            const Exchange         &exchange);
} // namespace Exemplar

#endif
