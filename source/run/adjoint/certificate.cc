// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/adjoint_checks.h>
#include <exemplar/run/adjoint/adjoint_solve.h>
#include <exemplar/run/adjoint/certificate.h>
#include <exemplar/run/adjoint/gradients.h>

#include <cmath>

namespace Exemplar
{
  double
  correction(Problem &problem, const Direction &by_state)
  {
    require_known_scene(problem);
    require_rotations(problem);
    if (problem.constraints.handles.are_elsewhere(problem.state.time, problem.state.positions))
      throw UserError(
          "correction: held nodes are not where their motions put them. Call step() first, "
          "as a correction leaves them where they are.");
    Evaluation evaluation;
    problem.potential.evaluate(problem.state, RotationUse::update, evaluation);
    const Direction     adjoint = solve_adjoint(problem, evaluation, by_state).direction;
    const WeightMemory &memory  = problem.examples.weights.get_memory();
    // a is zero on held nodes and b sums to zero in each region, so that multipliers drop out; b is
    // zero where one-sided slopes differ
    double slope = adjoint.positions * evaluation.gradient;
    for (std::size_t i = 0; i < evaluation.elastic.weight_gradient.size(); ++i)
      slope
          += adjoint.weights[i]
             * memory.slopes(i, problem.state.weights[i], evaluation.elastic.weight_gradient[i]).up;
    if (!std::isfinite(slope))
      throw SolverFailure(too_large);
    return -slope;
  }
} // namespace Exemplar
