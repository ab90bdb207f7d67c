// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_clock_h
#define exemplar_step_clock_h

#include <array>
#include <chrono>
#include <string>

namespace Exemplar
{
  /// The phases of a run whose times are reported.
  enum class Phase
  {
    read,
    evaluate,
    assemble,
    factorize,
    solve,
    output
  };

  constexpr unsigned int n_phases = 6;

  inline const std::array<std::string, n_phases> phase_names
      = { { "read", "evaluate", "assemble", "factorize", "solve", "output" } };

  using PhaseSeconds = std::array<double, n_phases>;

  /// Attributes every moment to exactly one phase, so that the phases sum to the
  /// whole. Times are only ever reported; no decision depends on them.
  class StepClock
  {
  public:
    /// Time belongs to `phase` while this object lives, then again to the phase before.
    class Scope
    {
    public:
      Scope(StepClock &clock, const Phase phase) : clock(clock), before(clock.current)
      {
        clock.switch_to(phase);
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
      StepClock  &clock;
      const Phase before;
    };

    explicit StepClock(const Phase first) : current(first), since(std::chrono::steady_clock::now())
    {
    }

    void
    switch_to(const Phase phase)
    {
      const auto now = std::chrono::steady_clock::now();
      seconds[static_cast<unsigned int>(current)]
          += std::chrono::duration<double>(now - since).count();
      since   = now;
      current = phase;
    }

    /// Seconds of each phase until now.
    const PhaseSeconds &
    read()
    {
      switch_to(current);
      return seconds;
    }

  private:
    Phase                                 current;
    std::chrono::steady_clock::time_point since;
    PhaseSeconds                          seconds{};
  };
} // namespace Exemplar

#endif
