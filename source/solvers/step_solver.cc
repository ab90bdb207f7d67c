// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/frozen_passes.h>
#include <exemplar/solvers/newton.h>
#include <exemplar/solvers/quasi_newton.h>
#include <exemplar/solvers/step_solver.h>

namespace Exemplar
{
  bool
  StepSolver::report_iteration(const IncrementalPotential &potential,
                               const Evaluation           &evaluation,
                               State                      &state,
                               SolveReport                &report) const
  {
    const Residual residual = potential.residual(state, evaluation);
    report.residual         = residual.positions;
    report.kkt_residual     = residual.weights;
    state.multipliers       = residual.multipliers;
    report.residual_history.push_back(report.residual);
    return !observe || observe(report);
  }

  std::unique_ptr<StepSolver>
  make_step_solver(const SolverParameters &parameters,
                   IncrementalPotential   &potential,
                   StepSystem             &system,
                   const Handles          &handles,
                   StepClock              &clock)
  {
    switch (parameters.method)
    {
    case Method::newton:
      return std::make_unique<Newton>(parameters, potential, system, handles, clock);
    case Method::quasi_newton:
      return std::make_unique<QuasiNewton>(parameters, potential, system, handles, clock);
    default:
      return std::make_unique<FrozenPasses>(parameters, potential, system, handles, clock);
    }
  }
} // namespace Exemplar
