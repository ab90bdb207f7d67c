// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/progress.h>

#include <algorithm>
#include <sstream>
#include <system_error>

namespace Exemplar
{
  namespace
  {
    using std::chrono::milliseconds;

    // signs of life at least every 5 s
    constexpr milliseconds line_interval(4000);

    // a bar that changes faster cannot be read, and shorter steps need no other sign of life
    constexpr milliseconds bar_interval(100), sign_interval(500), long_step(1000);

    double
    seconds_between(const std::chrono::steady_clock::time_point a,
                    const std::chrono::steady_clock::time_point b)
    {
      return std::chrono::duration<double>(b - a).count();
    }

    std::string
    duration_text(const double seconds)
    {
      std::ostringstream text;
      const auto         whole = static_cast<long>(seconds + 0.5);
      if (whole >= 3600)
        text << whole / 3600 << " h " << (whole % 3600) / 60 << " min";
      else if (whole >= 60)
        text << whole / 60 << " min " << whole % 60 << " s";
      else
        text << whole << " s";
      return text.str();
    }
  } // namespace

  Progress::Progress(std::ostream      &out,
                     const bool         is_terminal,
                     const bool         quiet,
                     const unsigned int first,
                     const unsigned int n_steps,
                     const std::string &unit)
      : out(out), is_terminal(is_terminal), quiet(quiet), first(first), n_steps(n_steps),
        unit(unit), begin(Clock::now()), done(first), step_begin(begin), last_shown(begin)
  {
  }

  Progress::~Progress()
  {
    finish();
  }

  void
  Progress::go_on(const std::string &note)
  {
    if (quiet)
      return;
    const std::lock_guard<std::mutex> lock(mutex);
    under_way = note;
    if (watcher.joinable() || ended)
      return;
    try
    {
      watcher = std::thread([this] { watch(); });
    }
    catch (const std::system_error &)
    {
      ended = true; // no thread available: the run matters more than its display
    }
  }

  void
  Progress::go_on_with(const unsigned int step, const std::string &note)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (done + 1 != step)
        step_begin = Clock::now();
      done = step - 1;
    }
    go_on(note);
  }

  Progress::Clock::time_point
  Progress::next_sign() const
  {
    return is_terminal ? std::max(last_shown + sign_interval, step_begin + long_step)
                       : last_shown + line_interval;
  }

  void
  Progress::watch()
  {
    std::unique_lock<std::mutex> lock(mutex);
    while (!ended)
    {
      changed.wait_until(lock, next_sign());
      const auto now = Clock::now();
      if (!ended && done < n_steps && now >= next_sign())
      {
        last_shown = now;
        show(done + 1, duration_text(seconds_between(step_begin, now)) + " so far", under_way);
      }
      else if (!ended && done == n_steps)
        changed.wait(lock); // wait for the end
    }
  }

  void
  Progress::update(const unsigned int step, const std::string &note)
  {
    if (quiet)
      return;
    const std::lock_guard<std::mutex> lock(mutex);
    const auto                        now = Clock::now();

    done       = step;
    step_begin = now;
    under_way.clear();
    if (step == n_steps || now >= last_shown + (is_terminal ? bar_interval : line_interval))
    {
      last_shown        = now;
      const double left = seconds_between(begin, now) / (step - first) * (n_steps - step);
      show(step, duration_text(left) + " left", note);
    }
  }

  void
  Progress::show(const unsigned int step, const std::string &duration, const std::string &note)
  {
    std::ostringstream text;
    if (is_terminal)
    {
      const unsigned int width = 20, filled = width * done / n_steps;
      text << '[' << std::string(filled, '#') << std::string(width - filled, '.') << "] ";
    }
    text << unit << " " << step << " of " << n_steps << ", " << duration
         << (note.empty() ? "" : ", ") << note;
    if (is_terminal) // overwrite the line; "\033[K" clears the rest of it
      out << '\r' << text.str().substr(0, 79) << "\033[K" << std::flush;
    else
      out << text.str() << std::endl;
    line_open = is_terminal;
  }

  void
  Progress::finish()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      ended = true;
    }
    changed.notify_all();
    if (watcher.joinable())
      watcher.join();
    if (line_open)
      out << std::endl;
    line_open = false;
  }
} // namespace Exemplar
