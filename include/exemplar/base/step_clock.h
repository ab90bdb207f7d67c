// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_clock_h
#define exemplar_step_clock_h

#include <array>
#include <chrono>
#include <string>

namespace Exemplar
{
  /// The parts of a run whose times are reported.
  enum class Part
  {
    read,
    evaluate,
    assemble,
    factorize,
    solve,
    output
  };

  constexpr unsigned int n_parts = 6;

  inline const std::array<std::string, n_parts> part_names
      = { { "read", "evaluate", "assemble", "factorize", "solve", "output" } };

  using PartSeconds = std::array<double, n_parts>;

  /// Attributes every moment to exactly one part, so that the parts sum to the
  /// whole. Times are only ever reported; no decision depends on them.
  class StepClock
  {
  public:
    /// Time belongs to `part` while this object lives, then again to the part before.
    class Scope
    {
    public:
      Scope(StepClock &clock, const Part part) : clock(clock), before(clock.current)
      {
        clock.switch_to(part);
      }

      ~Scope()
      {
        clock.switch_to(before);
      }

      Scope(const Scope &) = delete;
      Scope &
      operator=(const Scope &)
          = delete;

    private:
      StepClock &clock;
      const Part before;
    };

    explicit StepClock(const Part first) : current(first), since(std::chrono::steady_clock::now())
    {
    }

    void
    switch_to(const Part part)
    {
      const auto now = std::chrono::steady_clock::now();
      seconds[static_cast<unsigned int>(current)]
          += std::chrono::duration<double>(now - since).count();
      since   = now;
      current = part;
    }

    /// Seconds of each part until now.
    const PartSeconds &
    read()
    {
      switch_to(current);
      return seconds;
    }

  private:
    Part                                  current;
    std::chrono::steady_clock::time_point since;
    PartSeconds                           seconds{};
  };
} // namespace Exemplar

#endif
