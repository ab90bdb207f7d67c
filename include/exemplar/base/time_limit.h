// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_time_limit_h
#define exemplar_time_limit_h

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>

namespace Exemplar
{
  /// Time limit of another process: in seconds of processor time of all its threads and of its
  /// children that have ended, since on a shared machine wall-clock time says little. As a sleeping
  /// process takes none, the limit of wall-clock time is thirty times as much.
  class TimeLimit
  {
  public:
    /// A limit that begins now.
    explicit TimeLimit(double processor_seconds);

    /// The limit that the process has exceeded, in words: "5 s of processor time", or "150 s". It
    /// must not have been waited for.
    std::optional<std::string>
    exceeded_by(pid_t process) const;

    /// Wall-clock seconds since the beginning.
    double
    seconds() const;

  private:
    const double                                processor_seconds;
    const std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  };
} // namespace Exemplar

#endif
