// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/output/run_account.h>

#include <algorithm>

namespace Exemplar
{
  void
  RunAccount::take_over(const RunTotals &earlier)
  {
    totals                 = earlier;
    earlier_factorizations = totals.factorizations;
  }

  void
  RunAccount::begin_steps()
  {
    clock.switch_to(Phase::evaluate);
    lap();
  }

  void
  RunAccount::add_step(const SolveReport &report, const unsigned int n_factorizations)
  {
    totals.iterations += report.iterations;
    totals.factorizations = earlier_factorizations + n_factorizations;
    totals.worst_residual = std::max(totals.worst_residual, report.residual);
  }

  PhaseSeconds
  RunAccount::lap()
  {
    const PhaseSeconds now = clock.read();
    PhaseSeconds       seconds;
    for (unsigned int part = 0; part < n_phases; ++part)
    {
      seconds[part] = now[part] - last_lap[part];
      totals.seconds[part] += seconds[part];
    }
    last_lap = now;
    return seconds;
  }
} // namespace Exemplar
