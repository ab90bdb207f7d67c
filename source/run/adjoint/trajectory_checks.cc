// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/adjoint_checks.h>
#include <exemplar/run/adjoint/trajectory_checks.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    void
    refuse_steps(const std::string &what, const std::string &remedy)
    {
      throw UserError(
          fmt::format("vjp: there are no gradients through steps {} yet. {}", what, remedy));
    }

  } // namespace

  void
  require_known_steps(const Problem &problem)
  {
    if (problem.parameters.scene == SceneKind::interpolation)
      refuse_steps("of interpolations", "Set Scene = static or dynamic.");
    if (problem.parameters.solver.method == Method::one_pass)
      refuse_steps("of one pass", "Set Solver/Method = auto.");
    if (problem.examples.weights.get_memory().in_use())
      refuse_steps("of weights that remember", "Set Examples/Yield and Creep viscosity to 0.");
    require_known_potential(problem);
  }

  double
  required_residual(const SolverParameters &solver)
  {
    return solver.method == Method::quasi_newton ? std::max(solver.tolerance, solver.step_tolerance)
                                                 : solver.tolerance;
  }

  void
  require_solved_step(const Problem &problem, const Evaluation &evaluation, const unsigned int step)
  {
    const double   bound    = std::max(1e-6, 10. * required_residual(problem.parameters.solver));
    const Residual residual = problem.potential.residual(problem.state, evaluation);
    const double   value    = std::max(residual.positions, residual.weights);
    if (!(value <= bound))
      throw UserError(fmt::format("vjp: step {}, counted from 0, ends in no equilibrium of its "
                                  "forces (residual {:.2g}, allowed {:.2g}). Lower "
                                  "Solver/Step tolerance, or Tolerance.",
                                  step, value, bound));
  }
} // namespace Exemplar
