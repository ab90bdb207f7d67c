// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/initial_state.h>
#include <exemplar/run/problem.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// By which the cell of a support may have turned [rad]; the matrix gets singular at
    /// 90 degrees. What frozen forces find depends on the support, so there it never may.
    constexpr double largest_turn = 0.7;

    SceneParameters
    completed(SceneParameters parameters)
    {
      parameters.complete();
      parameters.check();
      return parameters;
    }

    TimeAxis
    make_time_axis(const SceneParameters &parameters)
    {
      return parameters.scene == SceneKind::dynamic ? TimeAxis::of_dynamics(parameters.time)
                                                    : TimeAxis::of_increments(parameters.time);
    }

    std::unique_ptr<Handles>
    make_handles(const SceneParameters &parameters,
                 const Mesh            &mesh,
                 const TimeAxis        &axis,
                 const Inputs          &inputs)
    {
      if (parameters.handles.empty())
        return nullptr;
      return std::make_unique<Handles>(parameters.handles, mesh, axis, inputs.poses, inputs.nodes);
    }

    std::optional<StaticallyDeterminateSupport>
    make_support(const SceneParameters &parameters, const Mesh &mesh)
    {
      if (parameters.scene != SceneKind::interpolation)
        return {};
      return support_near_centroid(mesh);
    }

    std::unique_ptr<Loads>
    make_loads(const SceneParameters &parameters,
               const Mesh            &mesh,
               const FESpace         &fe_space,
               const Material        &material,
               const Inputs          &inputs)
    {
      if (parameters.loads.empty() && !parameters.has_gravity())
        return nullptr;
      const auto &[x, y, z] = parameters.gravity;
      return std::make_unique<Loads>(dealii::Tensor<1, 3>({ x, y, z }), parameters.loads, mesh,
                                     fe_space, material, inputs.nodes);
    }

    std::unique_ptr<ExamplePoses>
    make_examples(const SceneParameters &parameters,
                  const Mesh            &mesh,
                  const FESpace         &fe_space,
                  const Material        &material,
                  const TimeAxis        &axis,
                  const Inputs          &inputs)
    {
      if (!parameters.examples.in_use())
        return nullptr;
      return std::make_unique<ExamplePoses>(parameters.examples, parameters.model.strain, mesh,
                                            fe_space, material, axis, inputs.poses);
    }

    std::unique_ptr<Inertia>
    make_inertia(const SceneParameters &parameters,
                 const FESpace         &fe_space,
                 const Material        &material)
    {
      if (parameters.scene != SceneKind::dynamic)
        return nullptr;
      return std::make_unique<Inertia>(fe_space, material, parameters.material.mass_matrix,
                                       parameters.time);
    }

    /// Operations of CHOLMOD's factorisation, for each degree of freedom and solve with it,
    /// from which conjugate gradients are faster: measured, doc/results.md.
    constexpr double operations_at_crossover = 4e5;

    /// Residual of a linear solve over its right side. Newton's method and the fixed point
    /// correct the rest in their next iteration; one pass has none, and Schur complements
    /// are small differences of what these solves give.
    constexpr double tolerance_of_iterations = 1e-4, tolerance_of_last_word = 1e-8;

    /// Columns of G that are not zero.
    unsigned int
    n_coupled(const ExamplePoses *examples)
    {
      unsigned int n = 0;
      if (examples != nullptr && !examples->weights_are_prescribed())
        for (unsigned int weight = 0; weight < examples->n_weights(); ++weight)
          n += examples->is_strained(weight);
      return n;
    }

    /// CHOLMOD for a pattern, unless it is to be chosen and is not worth it.
    std::unique_ptr<SpdOperator>
    find_cholmod_operator(const SolverParameters &solver,
                          const unsigned int      n_columns,
                          const SymmetricPattern &pattern)
    {
      if (solver.linear_solver == LinearSolver::iterative)
        return nullptr;
      const bool may_choose = solver.linear_solver == LinearSolver::automatic
                              && solver.method != Method::quasi_newton;
      auto matrix = make_cholmod_operator();
      try
      {
        matrix->reinit(pattern);
      }
      catch (const SolverFailure &)
      {
        if (!may_choose)
          throw;
        return nullptr; // too large for CHOLMOD
      }
      if (may_choose && matrix->n_operations() > operations_at_crossover * n_columns * pattern.n())
        return nullptr;
      return matrix;
    }

    std::unique_ptr<BorderedSolver>
    make_linear_solver(const SolverParameters &solver,
                       const FESpace          &fe_space,
                       const FreeDofs         &free_dofs,
                       const ExamplePoses     *examples,
                       const SymmetricPattern &pattern)
    {
      if (solver.linear_solver == LinearSolver::umfpack)
        return make_umfpack_solver(pattern);
      const unsigned int n_examples = n_coupled(examples);
      auto               matrix     = find_cholmod_operator(solver, 1 + n_examples, pattern);
      if (matrix == nullptr)
      {
        const bool is_last_word = solver.method == Method::one_pass || n_examples > 0;
        matrix                  = make_iterative_operator(free_dofs, fe_space.rest_positions(),
                                         is_last_word ? tolerance_of_last_word
                                                                       : tolerance_of_iterations);
        matrix->reinit(pattern);
      }
      return make_block_solver(std::move(matrix));
    }
  } // namespace

  Problem::Problem(SceneParameters scene, Inputs inputs, StepClock running_clock)
      : parameters(completed(std::move(scene))), clock(std::move(running_clock)),
        time_axis(make_time_axis(parameters)),
        mesh(std::move(inputs.mesh), parameters.mesh.name(), parameters.mesh.scale),
        material(parameters.material, mesh.get_material_ids()), fe_space(mesh),
        handles(make_handles(parameters, mesh, time_axis, inputs)),
        support(make_support(parameters, mesh)), free_dofs(fe_space.n_dofs(), held_dofs()),
        loads(make_loads(parameters, mesh, fe_space, material, inputs)),
        examples(make_examples(parameters, mesh, fe_space, material, time_axis, inputs)),
        inertia(make_inertia(parameters, fe_space, material)),
        assembler(parameters.model, fe_space, material, examples.get(), inertia.get(), free_dofs),
        linear_solver(make_linear_solver(
            parameters.solver, fe_space, free_dofs, examples.get(), assembler.matrix_pattern())),
        equilibrium(parameters.solver,
                    { free_dofs, fe_space.rest_positions(), assembler, *linear_solver, clock,
                      handles.get(), loads.get(), examples.get(), inertia.get(),
                      support && turns_freely() && !parameters.model.is_frozen() }),
        diagnostics(handles.get(), loads.get(), examples.get(), inertia.get(), energy_is_bounded()),
        state(initial_state(parameters.initial,
                            mesh,
                            fe_space,
                            examples.get(),
                            parameters.scene == SceneKind::dynamic,
                            inputs.poses))
  {
    if (parameters.scene == SceneKind::statics)
      check_supports();
    if (parameters.scene == SceneKind::interpolation)
      start_interpolation();
    equilibrium.start(state);
  }

  std::vector<unsigned int>
  Problem::held_dofs() const
  {
    if (support)
      return support->held_dofs;
    if (handles == nullptr)
      return {};
    const std::vector<unsigned int> held = handles->held_dofs();
    if (held.size() == fe_space.n_dofs())
      throw UserError(parameters.name
                      + ": the handles hold every node, so there is nothing to solve. Make "
                        "Handles/NAME/Select smaller.");
    return held;
  }

  void
  Problem::check_supports() const
  {
    const unsigned int n_free = n_free_rigid_motions(mesh, held_dofs());
    if (n_free > 0)
      throw UserError(
          parameters.name + ": the handles leave " + std::to_string(n_free)
          + " of 6 rigid motions free, so a static scene has no unique equilibrium. Add a "
            "subsection of Handles that holds three nodes not on a line (a box, a sphere "
            "or a boundary), or hold more Components.");
  }

  void
  Problem::start_interpolation()
  {
    // the path begins at the pose that it begins with, unless another is asked for
    if (parameters.initial.pose.empty() && parameters.initial.pose_function.empty())
    {
      const auto greatest = std::max_element(state.weights.begin(), state.weights.end());
      state.positions     = examples->pose((greatest - state.weights.begin()) % examples->size());
    }
  }

  bool
  Problem::turns_freely() const
  {
    // infinitesimal rotations alone leave the linear strain as it is
    return parameters.model.strain != StrainMeasure::linear;
  }

  SolveReport
  Problem::advance()
  {
    State              next = state;
    const unsigned int step = state.step + 1;
    next.step               = step;
    if (support && turns_freely()
        && turn_to_support(mesh, *support, parameters.model.is_frozen() ? 0. : largest_turn,
                           next.positions))
    {
      next.linearized_positions.reinit(0); // not turned with it
      equilibrium.start(next);
    }
    const SolveReport report
        = equilibrium.solve(next, time_axis.time(step), time_axis.step_size(step));
    if (!is_success(report.status))
      equilibrium.restore({}); // what it remembers has seen the step that failed
    else
    {
      if (inertia != nullptr)
        inertia->end_step(state, next);
      if (support && turns_freely())
      {
        align(state.positions, next.positions);
        equilibrium.start(next);
      }
      diagnostics.add_work(state.positions, next, equilibrium.gradient());
      state = std::move(next);
    }
    return report;
  }

  void
  Problem::resume_from(const State &earlier, const QuasiNewtonMemory &memory)
  {
    state = earlier;
    equilibrium.forget_factor();
    equilibrium.restore(memory);
    equilibrium.start(state);
  }

  std::vector<std::string>
  Problem::parts(const bool present) const
  {
    const bool        has_weights = examples != nullptr && !examples->weights_are_prescribed();
    const std::string solver      = linear_solver->name();
    const std::vector<std::pair<std::string, bool>> all
        = { { "mass matrix", inertia != nullptr },
            { "second-order time scheme",
              inertia != nullptr && parameters.time.scheme != TimeScheme::implicit_euler },
            { "mass damping", inertia != nullptr && parameters.time.mass_damping > 0. },
            { "stiffness damping", inertia != nullptr && parameters.time.stiffness_damping > 0. },
            { "handles", handles != nullptr },
            { "own support of interpolation", support.has_value() },
            { "gravity", loads != nullptr && loads->has_gravity() },
            { "loads", loads != nullptr && loads->has_named_loads() },
            { "example poses", examples != nullptr },
            { "weight block", has_weights },
            { "weights per region", examples != nullptr && parameters.examples.weights_per_region },
            { "Schur complement", has_weights && solver != "umfpack" },
            { "CHOLMOD", solver == "cholesky" },
            { "algebraic multigrid", solver == "iterative" },
            { "UMFPACK", solver == "umfpack" },
            { "quasi-Newton method", equilibrium.memory_of_quasi_newton() > 0 },
            { "frame writer", parameters.output.every > 0 } };
    std::vector<std::string> names;
    for (const auto &[name, is_there] : all)
      if (is_there == present)
        names.push_back(name);
    return names;
  }

  std::vector<std::pair<std::string, std::size_t>>
  Problem::memory_of_parts() const
  {
    std::vector<std::pair<std::string, std::size_t>> parts
        = { { "mesh", mesh.memory_consumption() },
            { "cells", fe_space.memory_consumption() + assembler.memory_consumption() },
            { "mass matrix", inertia == nullptr ? 0 : inertia->memory_consumption() },
            { "example poses", examples == nullptr ? 0 : examples->memory_consumption() },
            { "weight block", equilibrium.memory_of_weights() },
            { "quasi-Newton method", equilibrium.memory_of_quasi_newton() } };
    if (const SpdOperator *matrix = linear_solver->matrix())
      parts.emplace_back("linear solver", matrix->memory_consumption());
    return parts;
  }

  std::vector<std::string>
  Problem::warnings() const
  {
    std::vector<std::string> all = mesh.get_warnings();
    if (parameters.model.gradient == GradientKind::frozen && !parameters.model.is_frozen())
      all.push_back(
          "Model/Gradient = frozen holds rotations, which this Model/Strain does not have: "
          "its forces are the gradient of its energy.");
    if (handles != nullptr)
      all.insert(all.end(), handles->get_warnings().begin(), handles->get_warnings().end());
    if (examples != nullptr)
      all.insert(all.end(), examples->get_warnings().begin(), examples->get_warnings().end());
    return all;
  }

  bool
  Problem::energy_is_bounded() const
  {
    const bool has_one_energy
        = examples == nullptr
          || (!examples->weights_are_prescribed() && !parameters.model.is_frozen());
    return inertia != nullptr && inertia->is_undamped_implicit_euler() && has_one_energy;
  }

  bool
  Problem::is_unloaded() const
  {
    if (parameters.scene != SceneKind::statics || loads != nullptr
        || (examples != nullptr && examples->weights_are_prescribed()))
      return false;
    dealii::Vector<double> held = fe_space.rest_positions();
    handles->move(state.time, held);
    held -= fe_space.rest_positions();
    return held.linfty_norm() < 1e-10 * mesh.diameter();
  }

  std::vector<std::string>
  Problem::warnings_at_end() const
  {
    std::vector<std::string> all;
    if (const unsigned int inverted = equilibrium.evaluation().inverted_cells)
      all.push_back(
          std::to_string(inverted)
          + " cells are inverted at the end. The state is an equilibrium, but there may be "
            "one of less energy: look at the frames, or take smaller steps.");
    // strains of 1e-4 are no accident
    if (is_unloaded() && equilibrium.evaluation().energy > 1e-8 * unit_energy(fe_space, material))
      all.push_back(
          "Nothing loads the body, but it has come to rest in a local minimum of its energy "
          "at "
          + shortest_text(equilibrium.evaluation().energy)
          + " J, where the rest pose has less: Initial/Pose may be too far from it.");
    return all;
  }
} // namespace Exemplar
