// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/text_file.h>
#include <exemplar/base/time_limit.h>

#include <fmt/core.h>

#include <sstream>
#include <unistd.h>

namespace Exemplar
{
  namespace
  {
    constexpr double clock_per_processor_time = 30.;

    /// Processor time [s] of a process and of its children that it has waited for.
    double
    processor_time_of(const pid_t process)
    {
      // the name, in parentheses, may hold any character; behind it are the state and, as 12th to
      // 15th, the times
      const std::string  stat = read_text_file(fmt::format("/proc/{}/stat", process)).value_or("");
      std::istringstream fields(stat.substr(stat.rfind(')') + 1));
      std::string        other;
      for (int i = 1; i < 12; ++i)
        fields >> other;
      double ticks = 0.;
      for (int i = 0; i < 4; ++i)
      {
        double of_one = 0.;
        fields >> of_one;
        ticks += of_one;
      }
      return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
    }
  } // namespace

  TimeLimit::TimeLimit(const double processor_seconds) : processor_seconds(processor_seconds) {}

  std::optional<std::string>
  TimeLimit::exceeded_by(const pid_t process) const
  {
    if (processor_time_of(process) > processor_seconds)
      return fmt::format("{:g} s of processor time", processor_seconds);
    if (const double limit = clock_per_processor_time * processor_seconds; seconds() > limit)
      return fmt::format("{:g} s", limit);
    return {};
  }

  double
  TimeLimit::seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
} // namespace Exemplar
