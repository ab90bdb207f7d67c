// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/adjoint_solve.h>
#include <exemplar/run/adjoint/adjoint_system.h>
#include <exemplar/run/adjoint/conjugate_residuals.h>
#include <exemplar/run/adjoint/example_strains.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Relative residuals of the adjoint equations: accepted at once, and too large after all
    /// corrections.
    constexpr double solved = 1e-9, unsolved = 1e-7;

    constexpr unsigned int max_corrections = 96;

    Direction
    image_of(const SlopeDerivatives &derivatives)
    {
      return { derivatives.by_positions, derivatives.by_weights };
    }

    /// Correct the solution of an approximate factor by conjugate residuals with exact derivatives;
    /// returns the relative residual.
    double
    correct(AdjointSystem         &system,
            const Direction       &by_state,
            const FindDerivatives &find,
            AdjointSolution       &solution)
    {
      ConjugateResiduals residuals(system.scale_of_weights());
      Direction          step = std::move(solution.direction), rest = system.projected(by_state);
      solution.direction = system.zero();
      double error       = 1.;
      for (unsigned int n = 0; n < max_corrections && !(error <= solved); ++n)
      {
        if (n > 0)
        {
          step = system.zero();
          system.add_solution(rest, step);
          solution.derivatives = find(step);
        }
        residuals.add(step, system.projected(image_of(solution.derivatives)), solution.direction,
                      rest);
        if (n == 0 || (n > 3 && n % 4 != 3))
          continue;
        solution.derivatives = find(solution.direction);
        error = system.residual(by_state, solution.direction, solution.derivatives, rest);
        rest  = system.projected(std::move(rest));
      }
      return error;
    }
  } // namespace

  std::vector<bool>
  are_inactive(const Problem &problem)
  {
    const std::vector<double> &weights = problem.state.weights;
    const WeightMemory        &memory  = problem.examples.weights.get_memory();
    const bool is_bounded = !problem.examples.weights.limits_of_changes(weights).lower.empty();
    std::vector<bool> inactive(problem.examples.weights.n_unknown());
    for (std::size_t weight = 0; weight < inactive.size(); ++weight)
    {
      const auto [up, down] = memory.slopes(weight, weights[weight], 0.);
      inactive[weight]      = (!is_bounded || weights[weight] > 0.) && !(up > down);
    }
    return inactive;
  }

  AdjointSolution
  solve_adjoint(AdjointSystem &system, const Direction &by_state, const FindDerivatives &find)
  {
    AdjointSolution solution;
    double          error;
    do
    {
      Direction rest     = by_state;
      solution.direction = system.zero();
      system.add_solution(by_state, solution.direction);
      solution.derivatives = find(solution.direction);
      error = system.residual(by_state, solution.direction, solution.derivatives, rest);
    } while (!(error <= solved) && system.sharpen());
    if (!(error <= solved))
      error = correct(system, by_state, find, solution);
    if (!(error <= unsolved))
      throw SolverFailure(fmt::format(
          "The adjoint equations are left with a residual of {:.2g} after {} corrections, "
          "because rounding is too large in so stiff a body, or the equilibrium is not stable.",
          error, max_corrections));
    return solution;
  }

  AdjointSolution
  solve_adjoint(Problem &problem, const Evaluation &evaluation, const Direction &by_state)
  {
    AdjointSystem system(problem);
    system.go_to_state(evaluation);
    const ExampleStrains strains(problem);
    return solve_adjoint(system, by_state,
                         [&](const Direction &direction)
                         { return derivatives_of_slope(problem, strains, direction); });
  }
} // namespace Exemplar
