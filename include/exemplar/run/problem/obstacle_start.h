// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_start_h
#define exemplar_obstacle_start_h

#include <exemplar/run/problem/problem_parts.h>

namespace Exemplar
{
  /// Throws UserError for an obstacle that goes more than a quarter of the body's diameter in a step.
  void
  check_obstacle_motions(const Obstacles &obstacles, const Body &body, const TimeAxis &axis);

  /// Let the obstacles suit a body that begins at these positions: what touches it is set back, of which `notes` tell,
  /// and pairs that begin nearer than the distance from which obstacles push keep their own. Throws UserError for a body
  /// that begins inside of one. All processes must call this.
  void
  suit_obstacles(Obstacles                &obstacles,
                 const ContactSurface     &surface,
                 const Body               &body,
                 const Vector             &positions,
                 std::vector<std::string> &notes);
} // namespace Exemplar

#endif
