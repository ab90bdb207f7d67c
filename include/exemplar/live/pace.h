// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_pace_h
#define exemplar_live_pace_h

#include <chrono>

namespace Exemplar::Live
{
  /// When steps are due, so that simulated time goes as fast as the clock, or honestly slower.
  class Pace
  {
  public:
    using Clock = std::chrono::steady_clock;

    /// Steps of this length [s].
    explicit Pace(double step_size);

    /// The next step is due now, as after a pause.
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

    /// When a step began.
    struct Moment
    {
      Clock::time_point time;
      double            processor; ///< [s], of this thread alone
    };

    static Moment
    now();

    /// A step was made that took from `begin` until now. What is behind is caught up, but no more than a
    /// tenth of a second of it.
    void
    add_step(const Moment &begin);

    /// How many steps should have been made that were not.
    double
    behind() const;

    /// What statuses tell of the time since the last one.
    struct Summary
    {
      double rate;         ///< simulated over real time
      double milliseconds; ///< a step, at most
      double processor;    ///< the same, without the time in which others had the processor
      double behind;       ///< steps, at most
    };

    /// Whether it is time for a status.
    bool
    wants_status() const;

    /// Begins a new one.
    Summary
    summary();

  private:
    const Clock::duration step;
    Clock::time_point     due, last_summary;
    unsigned int          n_steps = 0;                   ///< since then
    Clock::duration       longest_step{}, most_behind{}; ///< since then
    double                most_processor = 0.;           ///< of a step since then [s]
  };
} // namespace Exemplar::Live

#endif
