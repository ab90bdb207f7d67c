// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_solve_report_h
#define exemplar_solve_report_h

#include <string>
#include <vector>

namespace Exemplar
{
  /// How a step has ended; `initial`: there was none.
  enum class SolveStatus
  {
    initial,
    converged,
    one_pass,
    stalled,
    indefinite,
    iteration_limit,
    failed
  };

  /// The status as files and messages write it.
  std::string
  status_name(SolveStatus status);

  /// Whether a solve with this status has found the next state.
  inline bool
  is_success(const SolveStatus status)
  {
    return status == SolveStatus::converged || status == SolveStatus::one_pass;
  }

  /// How a solve ended.
  struct SolveReport
  {
    SolveStatus         status       = SolveStatus::initial;
    unsigned int        iterations   = 0;
    double              residual     = 0.;  ///< relative, doc/solver.md Eq. (13)
    double              kkt_residual = 0.;  ///< of the weights, relative, Eq. (13)
    std::vector<double> residual_history;   ///< one entry an iteration
    unsigned int        factorizations = 0; ///< without those that a resumed run makes again
    /// Half of what the energy would fall by in the last step along its slope [J]; an estimate of how far
    /// it was above its minimum before. 0 without Newton's and quasi-Newton steps.
    double       newton_decrement = 0.;
    double       step_length      = 1.; ///< of the last step, as the line search left it
    double       convexity        = 0.; ///< of the last tangent: 0 exact, 1 convex
    unsigned int load_stages      = 0;  ///< in which the forces were raised within the step
    std::string  failure;               ///< why, if the status is `failed` or `indefinite`
  };

  /// Whether both residuals are at most `tolerance`.
  inline bool
  has_met(const double tolerance, const SolveReport &report)
  {
    return report.residual <= tolerance && report.kkt_residual <= tolerance;
  }
} // namespace Exemplar

#endif
