// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/inventory.h>

namespace Exemplar
{
  namespace
  {
    /// Memory of the terms of this name; 0 if the potential has none.
    std::size_t
    memory_of_term(const Problem &problem, const std::string &name)
    {
      std::size_t bytes = 0;
      for (const auto &term : problem.potential.get_terms())
        bytes += term->name() == name ? term->memory_consumption() : 0;
      return bytes;
    }

    std::size_t
    memory_of_mass(const Problem &problem)
    {
      const Actions &actions = problem.actions;
      return actions.mass == nullptr
                 ? 0
                 : actions.mass->memory_consumption() + actions.integrator->memory_consumption()
                       + memory_of_term(problem, "inertia");
    }

    std::size_t
    memory_of_quasi_newton(const Problem &problem)
    {
      return problem.parameters.solver.method == Method::quasi_newton
                 ? problem.solver->memory_consumption()
                 : 0;
    }
  } // namespace

  std::vector<PartOfProblem>
  inventory(const Problem &problem)
  {
    const TimeParameters &time          = problem.parameters.time;
    const Actions        &actions       = problem.actions;
    const ExamplePoses   &poses         = problem.examples.poses;
    const bool            is_dynamic    = actions.mass != nullptr;
    const bool            finds_weights = problem.examples.weights.n_unknown() > 0;
    const OperatorTraits  solver        = problem.system.bordered().traits();
    const auto            solver_is     = [&](const char *name) { return solver.name == name; };
    const bool            has_gravity   = actions.loads != nullptr && actions.loads->has_gravity();
    const std::size_t     loads         = memory_of_term(problem, "loads");
    const std::size_t     quasi_newton  = memory_of_quasi_newton(problem);
    const std::size_t     cells
        = problem.body.fe_space.memory_consumption() + problem.elastic->memory_consumption();
    std::vector<PartOfProblem> parts = {
      { "mesh", {}, problem.body.mesh.memory_consumption() },
      { "cells", {}, cells },
      { "quadratic elements", traits_of(problem.parameters.model.element).degree == 2, {} },
      { "mass matrix", is_dynamic, memory_of_mass(problem) },
      { "second-order time scheme", is_dynamic && time.scheme != TimeScheme::implicit_euler, {} },
      { "mass damping", is_dynamic && time.mass_damping > 0., {} },
      { "stiffness damping", is_dynamic && time.stiffness_damping > 0., {} },
      { "handles", problem.constraints.handles.size() > 0, {} },
      { "own support of interpolation", problem.constraints.support.has_value(), {} },
      { "gravity", has_gravity, has_gravity ? loads : 0 }, // one vector for gravity and loads
      { "loads", actions.loads != nullptr && actions.loads->has_named_loads(),
        has_gravity ? 0 : loads },
      { "obstacles", actions.obstacles != nullptr, memory_of_term(problem, "obstacles") },
      { "weak springs", memory_of_term(problem, "weak springs") > 0,
        memory_of_term(problem, "weak springs") },
      { "body contact", actions.body_contacts != nullptr, memory_of_term(problem, "body contact") },
      { "ties", !problem.body.ties.empty(), memory_of_term(problem, "ties") },
      { "initial stresses", !actions.initial_stresses.empty(),
        memory_of_term(problem, "initial stress") },
      { "plastic cells", problem.has_trait(&ModelTraits::plastic_strain), {} },
      { "mean dilatation by patches", problem.body.patches.size() > 0, {} },
      { "example poses", poses.size() > 0, poses.size() > 0 ? poses.memory_consumption() : 0 },
      { "weight block", finds_weights, problem.system.memory_of_weights() },
      { "weights per region",
        poses.size() > 0
            && (problem.parameters.examples.weights_per_region
                || (problem.parameters.examples.finds_regions() && poses.n_regions() > 1)),
        {} },
      { "memory of weights", problem.examples.weights.get_memory().in_use(), {} },
      { "Schur complement", finds_weights && !solver_is("umfpack"), {} },
      { "Cholesky factor", solver_is("cholesky"), {} },
      { "CHOLMOD", solver_is("cholmod"), {} },
      { "algebraic multigrid", solver_is("iterative"), {} },
      { "UMFPACK", solver_is("umfpack"), {} },
      { "quasi-Newton method", quasi_newton > 0, quasi_newton },
      { "estimate of the error in space", problem.body.inputs != nullptr, {} },
      { "functional", !problem.parameters.output.functional.empty(), {} },
      { "frame writer", problem.parameters.output.every > 0, {} }
    };
    if (solver.bytes > 0)
      parts.push_back({ "linear solver", {}, solver.bytes });
    return parts;
  }
} // namespace Exemplar
