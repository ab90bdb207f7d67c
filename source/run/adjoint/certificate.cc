// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/adjoint_checks.h>
#include <exemplar/run/adjoint/adjoint_solve.h>
#include <exemplar/run/adjoint/certificate.h>

#include <numeric>

namespace Exemplar
{
  double
  correction(Problem &problem, const Direction &by_state)
  {
    require_known_scene(problem);
    require_rotations(problem);
    Evaluation evaluation;
    problem.potential.evaluate(problem.state, RotationUse::update, evaluation);
    const Direction            adjoint = solve_adjoint(problem, by_state).direction;
    const std::vector<double> &slopes  = evaluation.elastic.weight_gradient;
    // a is zero on held nodes, and b adds up to zero in each region, so that multipliers drop out
    return -(adjoint.positions * evaluation.gradient)
           - std::inner_product(slopes.begin(), slopes.end(), adjoint.weights.begin(), 0.);
  }
} // namespace Exemplar
