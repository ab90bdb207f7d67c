// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_interval_h
#define exemplar_step_interval_h

namespace Exemplar
{
  class Problem;

  /// When a step ends, and how long it is [s]; a step of no length solves a static scene once more.
  struct StepInterval
  {
    double end, size;
  };

  /// The step that follows a problem's state: that of the time axis if the state is at one of its times,
  /// else one of the same length from where the state is. Dynamics go on beyond Time/End; what has
  /// reached t = 1 elsewhere is solved there once more.
  StepInterval
  next_step(const Problem &problem);

  /// A step of this length [s]. Throws UserError unless it is a number above 0 that leads, in a scene
  /// that is not dynamic, to t = 1 at most.
  StepInterval
  step_of(const Problem &problem, double size);

  /// The next step, or a shorter one that ends at this time [s], which is after the state's.
  StepInterval
  step_towards(const Problem &problem, double time);

  /// Whether a problem's state is at this time [s], or after it, to a billionth of a step.
  bool
  has_reached(const Problem &problem, double time);

  /// t of the last step of the scene [s].
  double
  end_of_scene(const Problem &problem);

  /// Throws UserError if prescribed weights, which are looked at in the times of the axis alone when a
  /// problem is made, do not sum to one at the end of a step.
  void
  check_weights(const Problem &problem, const StepInterval &step);
} // namespace Exemplar

#endif
