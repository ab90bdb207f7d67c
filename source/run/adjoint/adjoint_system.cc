// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/adjoint_solve.h>
#include <exemplar/run/adjoint/adjoint_system.h>
#include <exemplar/solvers/step_system.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// UMFPACK factorises the bordered matrix as a whole and cannot solve with the positions' block
    /// alone.
    SolverParameters
    solver_for(const Problem &problem)
    {
      SolverParameters solver = problem.parameters.solver;
      if (solver.linear_solver == LinearSolver::umfpack)
        solver.linear_solver = LinearSolver::automatic;
      return solver;
    }
  } // namespace

  AdjointSystem::AdjointSystem(Problem &problem)
      : problem(problem), free(problem.potential.get_free_dofs().list()),
        form(problem.potential.get_weights().weight_form()),
        system(
            problem.potential,
            [&problem] { return make_bordered_system(solver_for(problem), problem.potential); },
            problem.clock,
            false)
  {
  }

  void
  AdjointSystem::go_to_state(const Evaluation &evaluation)
  {
    inactive      = are_inactive(problem);
    guarded_cells = evaluation.elastic.guarded_cells;
    make_factor();
  }

  bool
  AdjointSystem::sharpen()
  {
    if (!is_rough)
      return false;
    is_rough = false;
    make_factor();
    return true;
  }

  void
  AdjointSystem::make_factor()
  {
    factorize();
    Z = system.bordered().columns();
    if (!Z.empty())
      system.bordered().apply_inverse(Z);
    make_weight_matrix();
  }

  /// The exact tangent may be indefinite in cells that Eq. (16) guards; the convexified one is then
  /// a good enough preconditioner.
  void
  AdjointSystem::factorize()
  {
    try
    {
      factorize(0.);
    }
    catch (const SolverFailure &)
    {
      if (guarded_cells == 0)
        throw;
      factorize(1.);
    }
  }

  void
  AdjointSystem::factorize(const double convexity)
  {
    const State &at = problem.state;
    if (is_rough)
      system.factorize_roughly(at.positions, at.weights, convexity);
    else
      system.factorize(at.positions, at.weights, convexity);
  }

  Direction
  AdjointSystem::zero() const
  {
    return { Vector(problem.state.positions.size()),
             std::vector<double>(problem.state.weights.size(), 0.) };
  }

  double
  AdjointSystem::scale_of_weights()
  {
    double of_columns = 0., of_form = 0.;
    for (const double entry : system.bordered().columns())
      of_columns = std::max(of_columns, std::abs(entry));
    for (unsigned int i = 0; i < form.H.m(); ++i)
      of_form = std::max(of_form, std::abs(form.H(i, i)));
    return of_columns > 0. && of_form > 0. ? of_columns / of_form : 1.;
  }

  void
  AdjointSystem::add_solution(const Direction &right_side, Direction &direction)
  {
    std::vector<double> z;
    z.reserve(free.size());
    for (const unsigned int dof : free)
      z.push_back(right_side.positions[dof]);
    system.bordered().apply_inverse(z);
    const std::vector<double> b = solve_weights(right_side);
    for (std::size_t j = 0; j < form.coupled.size(); ++j)
      for (std::size_t i = 0; i < free.size(); ++i)
        z[i] += b[form.coupled[j]] * Z[j * free.size() + i];
    for (std::size_t i = 0; i < free.size(); ++i)
      direction.positions[free[i]] += z[i];
    for (std::size_t weight = 0; weight < b.size(); ++weight)
      direction.weights[weight] += b[weight];
  }

  double
  AdjointSystem::residual(const Direction        &by_state,
                          const Direction        &direction,
                          const SlopeDerivatives &derivatives,
                          Direction              &rest)
  {
    rest       = by_state;
    double sum = 0., scale = greatest_of_columns(direction);
    rest.positions -= derivatives.by_positions;
    for (const unsigned int dof : free)
    {
      sum   = std::max(sum, std::abs(rest.positions[dof]));
      scale = std::max(
          { scale, std::abs(by_state.positions[dof]), std::abs(derivatives.by_positions[dof]) });
    }
    double of_weights = 0., scale_of_weights = scale_of_terms(direction);
    for (std::size_t weight = 0; weight < inactive.size(); ++weight)
    {
      rest.weights[weight] -= derivatives.by_weights[weight];
      scale_of_weights = std::max(scale_of_weights, std::abs(by_state.weights[weight]));
    }
    subtract_multipliers(rest);
    for (std::size_t weight = 0; weight < inactive.size(); ++weight)
      if (inactive[weight])
        of_weights = std::max(of_weights, std::abs(rest.weights[weight]));
    return std::max(scale > 0. ? sum / scale : 0.,
                    scale_of_weights > 0. ? of_weights / scale_of_weights : 0.);
  }

  double
  AdjointSystem::greatest_of_columns(const Direction &direction)
  {
    double                     greatest = 0.;
    const std::vector<double> &G        = system.bordered().columns();
    for (std::size_t j = 0; j < form.coupled.size(); ++j)
      for (std::size_t i = 0; i < free.size(); ++i)
        greatest = std::max(greatest,
                            std::abs(G[j * free.size() + i] * direction.weights[form.coupled[j]]));
    return greatest;
  }

  double
  AdjointSystem::scale_of_terms(const Direction &direction)
  {
    std::vector<double>        sums(form.H.m(), 0.);
    const std::vector<double> &G = system.bordered().columns();
    for (std::size_t j = 0; j < form.coupled.size(); ++j)
      for (std::size_t i = 0; i < free.size(); ++i)
        sums[form.coupled[j]] += std::abs(G[j * free.size() + i] * direction.positions[free[i]]);
    for (unsigned int i = 0; i < form.H.m(); ++i)
      for (unsigned int j = 0; j < form.H.m(); ++j)
        sums[i] += std::abs(form.H(i, j) * direction.weights[j]);
    return sums.empty() ? 0. : *std::max_element(sums.begin(), sums.end());
  }

  /// The multiplier is the region's mean over the weights at no bound.
  void
  AdjointSystem::subtract_multipliers(Direction &rest) const
  {
    for (unsigned int region = 0; region < form.N.m(); ++region)
    {
      double sum = 0., n = 0.;
      for (unsigned int weight = 0; weight < form.N.n(); ++weight)
        if (form.N(region, weight) != 0. && inactive[weight])
        {
          sum += rest.weights[weight];
          ++n;
        }
      for (unsigned int weight = 0; weight < form.N.n(); ++weight)
        if (form.N(region, weight) != 0. && n > 0.)
          rest.weights[weight] -= sum / n;
    }
  }

  /// The inverse of the Schur complement, bordered by the sums; rows of weights at a bound are
  /// multiples of the identity's.
  void
  AdjointSystem::make_weight_matrix()
  {
    const unsigned int k = form.H.m(), m = form.N.m();
    if (k == 0)
      return;
    const auto schur
        = make_schur_complement(form, system.bordered().columns(), Z.data(), free.size(),
                                problem.potential.get_free_dofs().exchange());
    size_of_sums = schur.linfty_norm();
    inverse.reinit(k + m, k + m);
    for (unsigned int i = 0; i < k; ++i)
    {
      for (unsigned int j = 0; j < k; ++j)
        inverse(i, j) = inactive[i] && inactive[j] ? schur(i, j) : 0.;
      if (!inactive[i])
        inverse(i, i) = size_of_sums;
      for (unsigned int region = 0; region < m; ++region)
        inverse(i, k + region) = inverse(k + region, i)
            = inactive[i] ? size_of_sums * form.N(region, i) : 0.;
    }
    inverse.gauss_jordan();
  }

  std::vector<double>
  AdjointSystem::solve_weights(const Direction &right_side) const
  {
    const unsigned int     k = form.H.m();
    dealii::Vector<double> right(inverse.m()), solution(inverse.m());
    for (unsigned int weight = 0; weight < k; ++weight)
      right[weight] = inactive[weight] ? right_side.weights[weight] : 0.;
    for (std::size_t j = 0; j < form.coupled.size(); ++j)
      for (std::size_t i = 0; inactive[form.coupled[j]] && i < free.size(); ++i)
        right[form.coupled[j]] += Z[j * free.size() + i] * right_side.positions[free[i]];
    if (k > 0)
      inverse.vmult(solution, right);
    return { solution.begin(), solution.begin() + k };
  }
} // namespace Exemplar
