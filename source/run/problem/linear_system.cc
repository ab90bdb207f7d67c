// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/problem_parts.h>

#include <algorithm>

// Which linear solver a scene gets.

namespace Exemplar
{
  namespace
  {
    /// Operations of a factorisation, for each value of the matrix that multigrid would have, from which
    /// multigrid is faster: measured, doc/measured.md. Columns of weights beside the right side take
    /// conjugate gradients as long as that; quasi-Newton's method finds them with each new matrix alone,
    /// and has a factor in single precision.
    double
    operations_at_crossover(const Method method, const unsigned int n_examples)
    {
      return method == Method::quasi_newton ? 2.8e4 * (1. + 0.25 * n_examples)
                                            : 1.2e4 * (1. + n_examples);
    }

    /// Of a matrix without the couplings of outer products, as multigrid has it. In a mesh of linear
    /// tetrahedra a node has 14 neighbours, half of which are in the lower triangle.
    double
    n_values_in_parts(const IncrementalPotential &potential)
    {
      const SymmetricPattern &pattern = potential.get_tangent().get_pattern();
      return potential.get_cells().couples_by_products() ? 21. * pattern.n()
                                                         : static_cast<double>(pattern.n_values());
    }

    /// Residual of a linear solve over its right side. Newton's method and the fixed point
    /// correct the rest in their next iteration; one pass has none, and Schur complements
    /// are small differences of what these solves give.
    constexpr double tolerance_of_iterations = 1e-4, tolerance_of_last_word = 1e-8;

    double
    tolerance_of_solves(const SolverParameters &solver, const unsigned int n_examples)
    {
      if (solver.method == Method::one_pass)
        return std::min(tolerance_of_last_word, solver.tolerance);
      return n_examples > 0 ? tolerance_of_last_word : tolerance_of_iterations;
    }

    /// A Cholesky factorisation for a pattern, unless it is to be chosen and is not worth it.
    std::unique_ptr<SpdOperator>
    find_cholesky_operator(const SolverParameters     &solver,
                           const unsigned int          n_processes,
                           const unsigned int          n_examples,
                           const IncrementalPotential &potential)
    {
      if (solver.linear_solver == LinearSolver::iterative || n_processes > 1)
        return nullptr;
      const bool may_choose
          = solver.linear_solver == LinearSolver::automatic && has_iterative_operator();
      auto matrix = solver.linear_solver == LinearSolver::cholmod
                        ? make_cholmod_operator()
                        : make_cholesky_operator(solver.n_threads);
      try
      {
        const SymmetricPattern &pattern = potential.get_tangent().get_pattern();
        matrix->reinit(pattern.plain == nullptr
                           ? pattern
                           : *pattern.plain); // couplings that come and go choose nothing
      }
      catch (const SolverFailure &)
      {
        if (!may_choose)
          throw;
        return nullptr; // too large for its library
      }
      if (may_choose
          && matrix->traits().n_operations > operations_at_crossover(solver.method, n_examples)
                                                 * n_values_in_parts(potential))
        return nullptr;
      if (potential.get_tangent().get_pattern().plain != nullptr)
        matrix->reinit(potential.get_tangent().get_pattern());
      return matrix;
    }
  } // namespace

  bool
  is_assembled_in_parts(const SolverParameters &solver, const Exchange &exchange)
  {
    return solver.linear_solver == LinearSolver::iterative || exchange.n_processes() > 1;
  }

  std::unique_ptr<BorderedSystem>
  make_bordered_system(const SolverParameters &solver, IncrementalPotential &potential)
  {
    const Exchange &exchange = potential.get_free_dofs().exchange();
    potential.get_tangent().assemble_in_parts(is_assembled_in_parts(solver, exchange));
    const SymmetricPattern &pattern = potential.get_tangent().get_pattern();
    const WeightForm       &form    = potential.get_weights().weight_form();
    if (solver.linear_solver == LinearSolver::umfpack)
      return make_umfpack_system(pattern, form);
    const unsigned int n_examples = form.coupled.size();
    auto matrix = find_cholesky_operator(solver, exchange.n_processes(), n_examples, potential);
    if (matrix == nullptr)
    {
      potential.get_tangent().assemble_in_parts(true);
      matrix = make_iterative_operator(potential.get_free_dofs(),
                                       tolerance_of_solves(solver, n_examples));
      matrix->reinit(pattern);
    }
    return make_block_system(std::move(matrix), form, exchange);
  }
} // namespace Exemplar
