// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_progress_h
#define exemplar_progress_h

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>

namespace Exemplar
{
  /// Display of steps done and time left: a bar on a terminal, a line every few seconds elsewhere.
  /// A long step is shown to go on, whatever it computes meanwhile, by a thread that watches the
  /// clock. Only the display depends on that.
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

    Progress(const Progress &) = delete;
    Progress &
    operator=(const Progress &)
        = delete;

    ~Progress();

    /// Report that the step after those done is under way, with a `note` on its state. From the
    /// first call on long steps are shown.
    void
    go_on(const std::string &note);

    /// Report that step `step` is under way, and those before it are done, as go_on(). For steps of
    /// unlike durations, none of which predicts the others.
    void
    go_on_with(unsigned int step, const std::string &note);

    /// Report that step `step` is done; `note` is shown beside it.
    void
    update(unsigned int step, const std::string &note);

    /// Show no more, and end the line of the bar.
    void
    finish();

  private:
    using Clock = std::chrono::steady_clock;

    /// The function of the thread.
    void
    watch();

    /// Time at which the step under way is to be shown next.
    Clock::time_point
    next_sign() const;

    /// Show the step, its past or expected duration, and `note`.
    void
    show(unsigned int step, const std::string &duration, const std::string &note);

    std::ostream           &out;
    const bool              is_terminal;
    const bool              quiet;
    const unsigned int      first;
    const unsigned int      n_steps;
    const std::string       unit;
    const Clock::time_point begin;

    std::mutex              mutex; ///< guards the members below, and `out`
    std::condition_variable changed;
    unsigned int            done;
    std::string             under_way; ///< note on the step after `done`
    Clock::time_point       step_begin;
    Clock::time_point       last_shown;
    bool                    line_open = false;
    bool                    ended     = false;
    std::thread             watcher;
  };
} // namespace Exemplar

#endif
