// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/progress.h>

#include <sstream>

namespace Exemplar
{
  namespace
  {
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
        unit(unit), begin(Clock::now()), last_shown(begin)
  {
  }

  void
  Progress::update(const unsigned int step, const std::string &note)
  {
    const auto   now      = Clock::now();
    const double interval = is_terminal ? 0.1 : 5.;
    if (quiet || (step != n_steps && seconds_between(last_shown, now) < interval))
      return;
    last_shown = now;

    const double       left = seconds_between(begin, now) / (step - first) * (n_steps - step);
    std::ostringstream text;
    if (is_terminal)
    {
      const unsigned int width = 20, filled = width * step / n_steps;
      text << '[' << std::string(filled, '#') << std::string(width - filled, '.') << "] ";
    }
    text << unit << " " << step << " of " << n_steps << ", " << duration_text(left) << " left, "
         << note;
    if (is_terminal) // one line, whatever stood there before; "\033[K" clears the rest of it
      out << '\r' << text.str().substr(0, 79) << "\033[K" << std::flush;
    else
      out << text.str() << std::endl;
    line_open = is_terminal;
  }

  void
  Progress::finish()
  {
    if (line_open)
      out << std::endl;
    line_open = false;
  }
} // namespace Exemplar
