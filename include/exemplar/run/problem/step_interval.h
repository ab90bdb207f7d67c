// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_interval_h
#define exemplar_step_interval_h

namespace Exemplar
{
  class Problem;

  /// End and length of a step [s]; one of zero length solves a static scene again.
  struct StepInterval
  {
    double end, size;
  };

  /// The step after a problem's state: that of the time axis if the state is at one of its times,
  /// else one of the same length from the state's time. Dynamics continue beyond Time/End; other
  /// scenes that have reached t = 1 are solved there again.
  StepInterval
  next_step(const Problem &problem);

  /// A step of this length [s]. Throws UserError unless it is positive and, in a scene that is not
  /// dynamic, ends at t = 1 at most.
  StepInterval
  step_of(const Problem &problem, double size);

  /// The next step, or a shorter one that ends at this time [s], which must be after the state's.
  StepInterval
  step_towards(const Problem &problem, double time);

  /// Whether a problem's state has reached this time [s], to a billionth of a step.
  bool
  has_reached(const Problem &problem, double time);

  /// t of the last step of the scene [s].
  double
  end_of_scene(const Problem &problem);

  /// Throws UserError if prescribed weights do not sum to one at the end of a step; when a problem
  /// is made, they are checked at the times of the axis alone.
  void
  check_weights(const Problem &problem, const StepInterval &step);
} // namespace Exemplar

#endif
