// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/pace.h>

#include <algorithm>
#include <ctime>

namespace Exemplar::Live
{
  namespace
  {
    constexpr std::chrono::milliseconds max_debt(100), between_summaries(100);

    double
    seconds(const Pace::Clock::duration time)
    {
      return std::chrono::duration<double>(time).count();
    }
  } // namespace

  Pace::Pace(const double step_size)
      : step(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(step_size))),
        due(Clock::now()), last_summary(due)
  {
  }

  void
  Pace::restart()
  {
    due          = Clock::now();
    last_summary = due;
    n_steps      = 0;
  }

  Pace::Moment
  Pace::now()
  {
    timespec processor{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &processor);
    return { Clock::now(), processor.tv_sec + 1e-9 * processor.tv_nsec };
  }

  void
  Pace::add_step(const Moment &begin)
  {
    const Moment end = now();
    ++n_steps;
    due += step;
    longest_step   = std::max(longest_step, end.time - begin.time);
    most_processor = std::max(most_processor, end.processor - begin.processor);
    most_behind    = std::max(most_behind, end.time - due);
    due            = std::max(due, end.time - std::max<Clock::duration>(max_debt, step));
  }

  double
  Pace::behind() const
  {
    return std::max(0., seconds(Clock::now() - due) / seconds(step));
  }

  bool
  Pace::wants_status() const
  {
    return Clock::now() - last_summary >= between_summaries;
  }

  Pace::Summary
  Pace::summary()
  {
    const auto    now     = Clock::now();
    const Summary summary = { n_steps * seconds(step) / std::max(1e-9, seconds(now - last_summary)),
                              1e3 * seconds(longest_step), 1e3 * most_processor,
                              seconds(most_behind) / seconds(step) };
    last_summary          = now;
    n_steps               = 0;
    longest_step = most_behind = Clock::duration{};
    most_processor             = 0.;
    return summary;
  }
} // namespace Exemplar::Live
