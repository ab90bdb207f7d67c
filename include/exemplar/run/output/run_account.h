// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_account_h
#define exemplar_run_account_h

#include <exemplar/base/step_clock.h>
#include <exemplar/run/output/checkpoint.h>
#include <exemplar/solvers/solve_report.h>

namespace Exemplar
{
  /// Totals of a run, and the time between its steps.
  class RunAccount
  {
  public:
    /// `clock` must outlive this.
    explicit RunAccount(StepClock &clock) : clock(clock) {}

    /// Continue from these totals.
    void
    take_over(const RunTotals &earlier);

    /// Begin the steps: from now on, time that no other part of the clock claims, such as moving
    /// the handles, counts as evaluation.
    void
    begin_steps();

    /// Count a step; `n_factorizations` are those since the run began or went on.
    void
    add_step(const SolveReport &report, unsigned int n_factorizations);

    /// Seconds by part since the last call; adds them to the totals.
    PhaseSeconds
    lap();

    const RunTotals &
    get_totals() const
    {
      return totals;
    }

  private:
    StepClock   &clock;
    RunTotals    totals;
    unsigned int earlier_factorizations = 0; ///< before a resume
    PhaseSeconds  last_lap{};
  };
} // namespace Exemplar

#endif
