// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_pace_h
#define exemplar_live_pace_h

#include <chrono>

namespace Exemplar::Live
{
  /// The times at which steps are due, so that simulated time goes as fast as the clock, or slower
  /// where steps take longer.
  class Pace
  {
  public:
    using Clock = std::chrono::steady_clock;

    /// Takes the length of a step [s].
    explicit Pace(double step_size);

    /// Makes the next step due now, as after a pause.
    void
    restart();

    bool
    is_due() const
    {
      return Clock::now() >= due;
    }

    Clock::time_point
    get_due() const
    {
      return due;
    }

    /// A time on the clock and on the processor.
    struct Moment
    {
      Clock::time_point time;
      double            processor; ///< [s], of this thread alone
    };

    static Moment
    now();

    /// Counts a step that took from `begin` until now. A delay is caught up with, but no more than
    /// a tenth of a second of it, or one step if that is longer.
    void
    add_step(const Moment &begin);

    /// Number of steps that are overdue.
    double
    behind() const;

    /// Summary of the time since the last one, for statuses.
    struct Summary
    {
      double rate;         ///< simulated time over real time
      double milliseconds; ///< longest step [ms]
      double processor;    ///< longest step in processor time of this thread [ms]
      double behind;       ///< greatest delay [steps]
    };

    /// Whether it is time for a status.
    bool
    wants_status() const;

    /// The summary up to now; begins a new one.
    Summary
    summary();

  private:
    const Clock::duration step;
    Clock::time_point     due, last_summary;
    unsigned int          n_steps = 0;                   ///< since then
    Clock::duration       longest_step{}, most_behind{}; ///< since then
    double                most_processor = 0.;           ///< longest, since then [s]
  };
} // namespace Exemplar::Live

#endif
