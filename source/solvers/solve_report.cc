// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/key_table.h>
#include <exemplar/solvers/solve_report.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<SolveStatus> statuses = { { SolveStatus::initial, "initial" },
                                              { SolveStatus::converged, "converged" },
                                              { SolveStatus::one_pass, "one pass" },
                                              { SolveStatus::stalled, "stalled" },
                                              { SolveStatus::indefinite, "indefinite" },
                                              { SolveStatus::iteration_limit, "iteration limit" },
                                              { SolveStatus::failed, "failed" } };
  } // namespace

  std::string
  status_name(const SolveStatus status)
  {
    return enum_name(status, statuses);
  }
} // namespace Exemplar
