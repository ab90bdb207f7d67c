// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/step_adjoint.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Conjugate gradients are ended where they leave this part of what is allowed, as the exact
    /// derivatives have rounding of their own.
    constexpr double margin = 0.3;

    /// After so many iterations the next state gets a factor of its own, and this one if it comes to the
    /// second number. A factorisation costs as much as some ten of them.
    constexpr unsigned int many_iterations = 8, max_iterations = 25;

    /// The same of a factor that is not of an earlier state: what single precision loses.
    constexpr unsigned int max_iterations_of_own = 300;

    /// UMFPACK has no factor of the positions' part alone.
    SolverParameters
    solver_of_steps(const Problem &problem)
    {
      SolverParameters solver = problem.parameters.solver;
      if (solver.linear_solver == LinearSolver::umfpack)
        solver.linear_solver = LinearSolver::automatic;
      return solver;
    }

    double
    product_of(const BorderedVector &a, const BorderedVector &b)
    {
      return Exemplar::dot(a.positions, b.positions) + Exemplar::dot(a.weights, b.weights);
    }

    void
    add_vector(BorderedVector &a, const double factor, const BorderedVector &b)
    {
      Exemplar::add(a.positions, factor, b.positions);
      Exemplar::add(a.weights, factor, b.weights);
    }

    /// out += A x, of a matrix of which the lower triangle is given.
    void
    add_product(const SymmetricPattern    &pattern,
                const std::vector<double> &values,
                const std::vector<double> &x,
                std::vector<double>       &out)
    {
      for (unsigned int j = 0; j < pattern.n(); ++j)
      {
        const int diagonal = pattern.column_start[j];
        double    sum      = values[diagonal] * x[j];
        for (int k = diagonal + 1; k < pattern.column_start[j + 1]; ++k)
        {
          sum += values[k] * x[pattern.row[k]];
          out[pattern.row[k]] += values[k] * x[j];
        }
        out[j] += sum;
      }
    }
  } // namespace

  StepAdjoint::StepAdjoint(Problem &problem, const double tolerance)
      : problem(problem), tolerance(tolerance), free(problem.potential.get_free_dofs().list()),
        form(problem.potential.get_weights().weight_form()),
        system(make_bordered_system(solver_of_steps(problem), problem.potential))
  {
  }

  void
  StepAdjoint::go_to_state()
  {
    inactive = are_inactive(problem);
    problem.potential.assemble(problem.state.positions, problem.state.weights, 0.,
                               system->matrix_values(), system->columns(),
                               system->outer_products());
    problem.potential.get_free_dofs().assemble_columns(system->columns());
    is_own = false;
    if (is_worn || system->outer_products() != nullptr)
      factorize();
    else
      inverse.set_inactive(inactive);
  }

  void
  StepAdjoint::factorize()
  {
    inverse.reinit(*system, problem.state.positions, problem.potential.get_free_dofs().exchange());
    inverse.set_inactive(inactive);
    is_worn = false;
    is_own  = true;
    ++factorizations;
  }

  BorderedVector
  StepAdjoint::free_part(const Direction &direction) const
  {
    BorderedVector part;
    part.positions.reserve(free.size());
    for (const unsigned int dof : free)
      part.positions.push_back(direction.positions[dof]);
    part.weights.assign(form.H.m(), 0.);
    std::copy_n(direction.weights.begin(), part.weights.size(), part.weights.begin());
    return part;
  }

  BorderedVector
  StepAdjoint::product(const BorderedVector &vector) const
  {
    const std::size_t          n = free.size();
    const std::vector<double> &G = system->columns(), &b = vector.weights;
    BorderedVector result{ std::vector<double>(n, 0.), std::vector<double>(form.H.m(), 0.), {} };
    add_product(problem.potential.matrix_pattern(), system->matrix_values(), vector.positions,
                result.positions);
    for (std::size_t j = 0; j < form.coupled.size(); ++j)
    {
      const unsigned int weight = form.coupled[j];
      add(result.positions, -b[weight], G.data() + j * n);
      result.weights[weight] -= dot(vector.positions, G.data() + j * n);
    }
    for (unsigned int i = 0; i < form.H.m(); ++i)
      for (unsigned int j = 0; j < form.H.m(); ++j)
        result.weights[i] += form.H(i, j) * b[j];
    return result;
  }

  double
  StepAdjoint::residual(const BorderedVector &rest,
                        const Direction      &by_state,
                        const BorderedVector &direction) const
  {
    const std::size_t          n = free.size();
    const std::vector<double> &G = system->columns();
    std::vector<double>        of_weights(form.H.m(), 0.); // |H| |b| + |G|^T |a|
    double                     scale = 0., scale_of_weights = 0.;
    for (const unsigned int dof : free)
      scale = std::max(scale, std::abs(by_state.positions[dof]));
    for (unsigned int i = 0; i < form.H.m(); ++i)
      for (unsigned int j = 0; j < form.H.m(); ++j)
        of_weights[i] += std::abs(form.H(i, j) * direction.weights[j]);
    for (std::size_t j = 0; j < form.coupled.size(); ++j)
    {
      const double b = std::abs(direction.weights[form.coupled[j]]);
      for (std::size_t i = 0; i < n; ++i)
      {
        scale = std::max(scale, std::abs(G[j * n + i]) * b);
        of_weights[form.coupled[j]] += std::abs(G[j * n + i] * direction.positions[i]);
      }
    }
    for (unsigned int weight = 0; weight < form.H.m(); ++weight)
      scale_of_weights
          = std::max({ scale_of_weights, of_weights[weight], std::abs(by_state.weights[weight]) });
    const double of_rest  = max_entry(rest.positions.begin(), rest.positions.end());
    double       greatest = scale > 0. ? of_rest / scale : 0.;
    for (unsigned int region = 0; region < form.N.m(); ++region)
    {
      double sum = 0., n_inactive = 0.;
      for (unsigned int weight = 0; weight < form.N.n(); ++weight)
        if (form.N(region, weight) != 0. && inactive[weight])
        {
          sum += rest.weights[weight];
          ++n_inactive;
        }
      for (unsigned int weight = 0; weight < form.N.n(); ++weight)
        if (form.N(region, weight) != 0. && inactive[weight] && scale_of_weights > 0.)
          greatest = std::max(greatest,
                              std::abs(rest.weights[weight] - sum / n_inactive) / scale_of_weights);
    }
    return greatest;
  }

  bool
  StepAdjoint::find_solution(BorderedVector   right_side,
                             const Direction &by_state,
                             BorderedVector  &solution)
  {
    const unsigned int limit = is_own ? max_iterations_of_own : max_iterations;
    BorderedVector    &rest  = right_side;
    solution = { std::vector<double>(free.size(), 0.), std::vector<double>(form.H.m(), 0.), {} };
    BorderedVector next = rest;
    inverse.apply(next);
    BorderedVector along = next;
    double         slope = product_of(rest, next);
    for (unsigned int n = 1; n <= limit; ++n)
    {
      const BorderedVector of_along  = product(along);
      const double         curvature = product_of(along, of_along);
      if (!(curvature > 0. && slope > 0.))
        return slope == 0.;
      const double length = slope / curvature;
      add_vector(solution, length, along);
      add_vector(rest, -length, of_along);
      if (residual(rest, by_state, solution) <= margin * tolerance)
      {
        is_worn = !is_own && n > many_iterations;
        return true;
      }
      next = rest;
      inverse.apply(next);
      // by the change of the residual, as the inverse is not quite symmetric
      const double turn = -length * product_of(next, of_along) / slope;
      slope             = product_of(rest, next);
      for (auto *part : { &along.positions, &along.weights })
        for (double &number : *part)
          number *= turn;
      add_vector(along, 1., next);
    }
    return false;
  }

  void
  StepAdjoint::add_solution(const Direction &right_side,
                            const Direction &by_state,
                            Direction       &direction)
  {
    BorderedVector solution = free_part(right_side);
    if (system->outer_products() != nullptr)
      inverse.apply(solution); // of its own matrix, with all of its products
    else
    {
      const BorderedVector right = solution;
      if (!find_solution(right, by_state, solution) && !is_own)
      {
        factorize();
        find_solution(right, by_state, solution);
      }
    }
    for (std::size_t i = 0; i < free.size(); ++i)
      direction.positions[free[i]] += solution.positions[i];
    for (std::size_t weight = 0; weight < solution.weights.size(); ++weight)
      direction.weights[weight] += solution.weights[weight];
  }

  AdjointSolution
  StepAdjoint::solve(const Direction &by_state, const FindDerivatives &find)
  {
    AdjointSolution solution{ { Vector(problem.state.positions.size()),
                                std::vector<double>(problem.state.weights.size(), 0.) },
                              {} };
    Direction       rest  = by_state;
    double          error = 1.;
    unsigned int    n     = 0;
    for (; n < 6 && error > tolerance; ++n)
    {
      add_solution(rest, by_state, solution.direction);
      solution.derivatives = find(solution.direction);
      rest                 = by_state;
      rest.positions -= solution.derivatives.by_positions;
      for (std::size_t weight = 0; weight < rest.weights.size(); ++weight)
        rest.weights[weight] -= solution.derivatives.by_weights[weight];
      error = residual(free_part(rest), by_state, free_part(solution.direction));
    }
    if (!(error <= 100. * tolerance))
      throw SolverFailure(fmt::format(
          "vjp: the adjoint equations are left with a residual of {:.2g} after {} "
          "corrections, because rounding is too large in so stiff a body, or a guard acts.",
          error, n));
    return solution;
  }
} // namespace Exemplar
