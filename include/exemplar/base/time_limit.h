// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_time_limit_h
#define exemplar_time_limit_h

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>

namespace Exemplar
{
  /// How long another process may take: so many seconds of processor time, of all its threads and of
  /// those of its children that have ended, since a machine that others use, too, may leave it little of
  /// the clock. As one that sleeps takes none, it may take thirty times as much of the clock.
  class TimeLimit
  {
  public:
    /// From now on.
    explicit TimeLimit(double processor_seconds);

    /// What the process has gone beyond, in words: "5 s of processor time", or "150 s". It must not have
    /// been waited for.
    std::optional<std::string>
    exceeded_by(pid_t process) const;

    /// Seconds of the clock until now.
    double
    seconds() const;

  private:
    const double                                processor_seconds;
    const std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  };
} // namespace Exemplar

#endif
