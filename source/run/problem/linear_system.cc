// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/minimum_degree.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/problem_parts.h>

#include <algorithm>

// Choice of the linear solver.

namespace Exemplar
{
  namespace
  {
    /// Crossover: operations of a factorisation per matrix value of multigrid beyond which
    /// multigrid is faster, as measured, doc/measured.md. Each column of weights costs conjugate
    /// gradients as much as the right side; quasi-Newton's method solves for them only with new
    /// matrices, and factorises in single precision.
    double
    operations_at_crossover(const Method method, const unsigned int n_examples)
    {
      return method == Method::quasi_newton ? 2.8e4 * (1. + 0.25 * n_examples)
                                            : 1.2e4 * (1. + n_examples);
    }

    /// Number of matrix values without the couplings of outer products, as for multigrid. In a mesh
    /// of linear tetrahedra a node has 14 neighbours, half of them in the lower triangle.
    double
    n_values_in_parts(const IncrementalPotential &potential)
    {
      const SymmetricPattern &pattern = potential.get_tangent().get_pattern();
      return potential.get_body().couples_by_products() ? 21. * pattern.n()
                                                        : static_cast<double>(pattern.n_values());
    }

    /// Number of nodes from which on the best order of elimination, which METIS finds, takes seconds.
    constexpr unsigned int n_nodes_of_large_body = 60000;

    /// By how much that order may be better than one by minimum degree, and more.
    constexpr double max_gain_of_order = 40.;

    /// Whether so large a body has so many operations that multigrid is faster whatever their order. Patches couple more
    /// nodes than are looked at.
    bool
    is_beyond_factorizing(const SolverParameters &solver,
                          const FESpace          &fe_space,
                          const unsigned int      n_weights)
    {
      if (solver.linear_solver != LinearSolver::automatic || !has_iterative_operator()
          || fe_space.n_nodes() < n_nodes_of_large_body)
        return false;
      try
      {
        const SymmetricPattern pattern      = fe_space.lower_nodal_pattern();
        const double           n_operations = 27. * operations_by_minimum_degree(pattern);
        return n_operations > max_gain_of_order * operations_at_crossover(solver.method, n_weights)
                                  * 9. * pattern.n_values();
      }
      catch (const SolverFailure &)
      {
        return true; // too large for its library
      }
    }

    /// Relative residuals of linear solves. Newton's method and the fixed point correct errors in
    /// their next iteration; one pass does not, and Schur complements are small differences of
    /// solutions.
    constexpr double tolerance_of_iterations = 1e-4, tolerance_of_accurate_solves = 1e-8;

    double
    tolerance_of_solves(const SolverParameters &solver, const unsigned int n_examples)
    {
      if (solver.method == Method::one_pass)
        return std::min(tolerance_of_accurate_solves, solver.tolerance);
      return n_examples > 0 ? tolerance_of_accurate_solves : tolerance_of_iterations;
    }

    /// A Cholesky factorisation for a pattern; null if the choice is automatic and it does not pay.
    std::unique_ptr<SpdOperator>
    find_cholesky_operator(const SolverParameters     &solver,
                           const unsigned int          n_examples,
                           const IncrementalPotential &potential)
    {
      if (potential.get_tangent().is_always_in_parts())
        return nullptr;
      const bool may_choose = solver.linear_solver == LinearSolver::automatic
                              && has_iterative_operator()
                              && !potential.get_body().has_dense_products();
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
  is_assembled_in_parts(const SolverParameters &solver,
                        const FESpace          &fe_space,
                        const unsigned int      n_weights)
  {
    return solver.linear_solver == LinearSolver::iterative || fe_space.exchange().n_processes() > 1
           || is_beyond_factorizing(solver, fe_space, n_weights);
  }

  std::unique_ptr<BorderedSystem>
  make_bordered_system(const SolverParameters &solver, IncrementalPotential &potential)
  {
    const Exchange &exchange = potential.get_free_dofs().exchange();
    potential.get_tangent().assemble_in_parts(false); // unless it always is
    const SymmetricPattern &pattern = potential.get_tangent().get_pattern();
    const WeightForm       &form    = potential.get_weights().weight_form();
    if (solver.linear_solver == LinearSolver::umfpack)
      return make_umfpack_system(pattern, form);
    const unsigned int n_examples = form.coupled.size();
    auto               matrix     = find_cholesky_operator(solver, n_examples, potential);
    if (matrix == nullptr)
    {
      potential.get_tangent().assemble_in_parts(true);
      matrix = make_iterative_operator(potential.get_free_dofs(),
                                       tolerance_of_solves(solver, n_examples),
                                       potential.weakly_constrained_pieces());
      matrix->reinit(pattern);
    }
    if (potential.get_body().shears_unknowns())
      matrix = make_sheared_operator(std::move(matrix), potential.get_free_dofs().list().size());
    if (potential.get_body().has_dense_products())
      matrix = make_low_rank_operator(std::move(matrix), potential.get_free_dofs());
    return make_block_system(std::move(matrix), form, exchange);
  }
} // namespace Exemplar
