// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_start_h
#define exemplar_obstacle_start_h

#include <exemplar/potential/obstacle_term.h>
#include <exemplar/run/problem/problem_parts.h>

namespace Exemplar
{
  /// Throws UserError for an obstacle that goes more than a quarter of the body's diameter in a step, or turns by more than 1 rad.
  void
  check_obstacle_motions(const Obstacles &obstacles, const Body &body, const TimeAxis &axis);

  /// Where two obstacles are nearer to each other than a shell's thickness and two automatic distances from which obstacles push,
  /// choose a smaller distance, of which `notes` tell: a shell that is pushed from both sides wherever it is moves in tiny steps.
  void
  leave_room_for_shell(Obstacles                 &obstacles,
                       const ObstaclesParameters &parameters,
                       const ContactSurface      &surface,
                       const TimeAxis            &axis,
                       std::vector<std::string>  &notes);

  /// The scene with a factor instead of multigrid for a shell beside obstacles, with a warning if that was another choice.
  CompleteScene
  with_factor_beside_barriers(CompleteScene scene);

  /// Let the obstacles suit a body that begins at these positions and at this time [s]: what touches it is set back, of which `notes` tell,
  /// and pairs that begin nearer than the distance from which obstacles push keep their own. Throws UserError for a body
  /// that begins inside of one. All processes must call this.
  void
  suit_obstacles(Obstacles                &obstacles,
                 const ContactSurface     &surface,
                 const Body               &body,
                 const Vector             &positions,
                 double                    time,
                 std::vector<std::string> &notes);

  class Problem;

  /// Throws UserError where the body of a run that goes on is inside of an obstacle, which may not be where it was. All processes must
  /// call this.
  void
  check_resumed_obstacles(Problem &problem);

  /// A sentence for each obstacle that was near the body where no step ended. All processes must call this.
  std::vector<std::string>
  idle_obstacle_warnings(const Problem &problem);

  /// The term of the obstacles in a problem's potential; null without obstacles.
  ObstacleTerm *
  find_obstacle_term(const Problem &problem);

  /// The terms in a problem's potential of what the body touches: obstacles, and its own surface.
  std::vector<const TouchingTerm *>
  touching_terms(const Problem &problem);

  /// Of all that the body touches on its nodes, where it is now [N].
  Vector
  contact_forces(const Problem &problem);
} // namespace Exemplar

#endif
