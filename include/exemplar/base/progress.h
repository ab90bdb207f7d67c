// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_progress_h
#define exemplar_progress_h

#include <chrono>
#include <ostream>
#include <string>

namespace Exemplar
{
  /// Steps done and time left: a bar on a terminal, a line every few seconds
  /// elsewhere. Nothing but the display depends on its clock.
  class Progress
  {
  public:
    /// `out` shows the bar if it is a terminal; if `quiet`, nothing is shown. `first` steps are
    /// done already, of `n_steps`; `unit` is what a step is called.
    Progress(std::ostream      &out,
             bool               is_terminal,
             bool               quiet,
             unsigned int       first,
             unsigned int       n_steps,
             const std::string &unit = "step");

    /// Step `step` is done; `note` is shown beside it.
    void
    update(unsigned int step, const std::string &note);

    /// End the line of the bar.
    void
    finish();

  private:
    using Clock = std::chrono::steady_clock;

    std::ostream           &out;
    const bool              is_terminal;
    const bool              quiet;
    const unsigned int      first;
    const unsigned int      n_steps;
    const std::string       unit;
    const Clock::time_point begin;
    Clock::time_point       last_shown;
    bool                    line_open = false;
  };
} // namespace Exemplar

#endif
