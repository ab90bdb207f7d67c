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
  /// Steps done and time left: a bar on a terminal, a line every few seconds
  /// elsewhere. A step that takes long shows that it goes on, whatever it computes meanwhile:
  /// a thread looks at the clock. Nothing but the display depends on that.
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

    /// The step after those that are done is under way, and has come to what `note` says. From
    /// the first call on steps that take long are shown.
    void
    go_on(const std::string &note);

    /// The same, of step `step`: those before it are done. For steps that take unlike times, of which
    /// none tells how long the others will take.
    void
    go_on_with(unsigned int step, const std::string &note);

    /// Step `step` is done; `note` is shown beside it.
    void
    update(unsigned int step, const std::string &note);

    /// Show no more, and end the line of the bar.
    void
    finish();

  private:
    using Clock = std::chrono::steady_clock;

    /// What the thread does.
    void
    watch();

    /// When the step under way is to be shown next.
    Clock::time_point
    next_sign() const;

    /// Show `note` behind the step and how long it has taken or will take.
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
    std::string             under_way; ///< what the step after it has come to
    Clock::time_point       step_begin;
    Clock::time_point       last_shown;
    bool                    line_open = false;
    bool                    ended     = false;
    std::thread             watcher;
  };
} // namespace Exemplar

#endif
