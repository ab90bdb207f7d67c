// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/adjoint_solve.h>
#include <exemplar/run/adjoint/adjoint_system.h>
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/slope_derivatives.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Exemplar
{
  namespace
  {
    /// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983): minimises the residual, preconditioned
    /// from the left, over the steps; one step if the preconditioner is the exact inverse. A residual is then a
    /// displacement. Forces would not do: those of a stiff barrier that friction feels are many times greater than all others.
    class ConjugateResiduals
    {
    public:
      /// `of_weights`: factor of a weight's entry relative to a displacement in the inner product [m].
      explicit ConjugateResiduals(double of_weights) : of_weights(of_weights) {}

      /// Orthonormalise `image`, the image of `step`, against the earlier ones, and subtract from
      /// `rest` its projection on it; add the same multiple of the step to `solution`.
      void
      add(Direction step, Direction image, Direction &solution, Direction &rest);

    private:
      double
      product(const Direction &a, const Direction &b) const;

      const double           of_weights;
      std::vector<Direction> steps, images; ///< images are orthonormal
    };

    void
    add_to(Direction &sum, const double factor, const Direction &direction)
    {
      sum.positions.add(factor, direction.positions);
      for (std::size_t i = 0; i < sum.weights.size(); ++i)
        sum.weights[i] += factor * direction.weights[i];
    }

    void
    scale(Direction &direction, const double factor)
    {
      direction.positions *= factor;
      for (double &weight : direction.weights)
        weight *= factor;
    }

    double
    ConjugateResiduals::product(const Direction &a, const Direction &b) const
    {
      double sum = a.positions * b.positions;
      for (std::size_t i = 0; i < a.weights.size(); ++i)
        sum += of_weights * of_weights * a.weights[i] * b.weights[i];
      return sum;
    }

    void
    ConjugateResiduals::add(Direction step, Direction image, Direction &solution, Direction &rest)
    {
      for (std::size_t k = 0; k < images.size(); ++k)
      {
        const double part = product(image, images[k]);
        add_to(image, -part, images[k]);
        add_to(step, -part, steps[k]);
      }
      const double norm = std::sqrt(product(image, image));
      if (!(norm > 0.))
        return;
      scale(image, 1. / norm);
      scale(step, 1. / norm);
      const double part = product(rest, image);
      add_to(solution, part, step);
      add_to(rest, -part, image);
      steps.push_back(std::move(step));
      images.push_back(std::move(image));
    }

    /// Relative residuals of the adjoint equations: accepted at once, and too large after all
    /// corrections.
    constexpr double solved = 1e-9, unsolved = 1e-7;

    constexpr unsigned int max_corrections = 96;

    Direction
    image_of(const SlopeDerivatives &derivatives)
    {
      return { derivatives.by_positions, derivatives.by_weights };
    }

    Direction
    preconditioned(AdjointSystem &system, const Direction &forces)
    {
      Direction step = system.zero();
      system.add_solution(forces, step);
      return step;
    }

    /// Correct the solution of an approximate factor by conjugate residuals with exact derivatives;
    /// returns the relative residual.
    double
    correct(AdjointSystem         &system,
            const Direction       &by_state,
            const FindDerivatives &find,
            AdjointSolution       &solution)
    {
      ConjugateResiduals residuals(1. / system.scale_of_weights());
      Direction          rest = std::move(solution.direction);
      solution.direction      = system.zero();
      double error            = 1.;
      for (unsigned int n = 0; n < max_corrections && !(error <= solved); ++n)
      {
        if (n > 0)
          solution.derivatives = find(rest);
        residuals.add(rest, preconditioned(system, image_of(solution.derivatives)),
                      solution.direction, rest);
        if (n == 0 || (n > 3 && n % 4 != 3))
          continue;
        solution.derivatives = find(solution.direction);
        Direction forces;
        error = system.residual(by_state, solution.direction, solution.derivatives, forces);
        rest  = preconditioned(system, forces);
      }
      return error;
    }
  } // namespace

  std::vector<bool>
  are_inactive(const Problem &problem)
  {
    const std::vector<double> &weights = problem.state.weights;
    const ExampleWeights      &rule    = problem.examples.weights;
    std::vector<bool>          inactive(rule.n_unknown());
    for (std::size_t weight = 0; weight < inactive.size(); ++weight)
    {
      const auto [up, down] = rule.get_memory().slopes(weight, weights[weight], 0.);
      inactive[weight]      = rule.is_off_bounds(weights[weight]) && !(up > down);
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
