// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_time_axis_h
#define exemplar_time_axis_h

#include <exemplar/body/time_parameters.h>

namespace Exemplar
{
  /// The times at which a scene is solved: 0, h, 2 h, ... End in dynamics, with a shorter last step
  /// if End is no whole number of steps; n increments of [0,1] otherwise. Times are computed from
  /// the number of the step, never accumulated, so that a resumed run sees the same ones.
  class TimeAxis
  {
  public:
    static TimeAxis
    of_dynamics(const TimeParameters &parameters);

    static TimeAxis
    of_increments(const TimeParameters &parameters);

    unsigned int
    n_steps() const
    {
      return steps;
    }

    /// t of step 0 ... n_steps() [s].
    double
    time(const unsigned int step) const
    {
      return step == steps && last_is_shorter ? end : step * length / divisor;
    }

    /// h of the step that ends at time(step) [s].
    double
    step_size(const unsigned int step) const
    {
      return step == steps && last_is_shorter ? end - time(step - 1) : length / divisor;
    }

  private:
    /// Steps of size length / divisor: a tenth is 1/10, not ten times 0.1.
    TimeAxis(unsigned int steps, double length, double divisor, double end);

    unsigned int steps;
    double       length;
    double       divisor;
    double       end;
    bool         last_is_shorter;
  };
} // namespace Exemplar

#endif
