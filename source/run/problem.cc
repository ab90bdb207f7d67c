// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/initial_state.h>
#include <exemplar/run/problem.h>

#include <boost/archive/archive_exception.hpp>

#include <algorithm>
#include <sstream>

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
                  const Inputs          &inputs)
    {
      if (!parameters.examples.in_use())
        return nullptr;
      return std::make_unique<ExamplePoses>(parameters.examples, parameters.model.strain, mesh,
                                            fe_space, material, inputs.poses);
    }

    std::unique_ptr<ExampleWeights>
    make_weights(const SceneParameters &parameters,
                 const ExamplePoses    *examples,
                 const double           energy_of_unit_strain,
                 const TimeAxis        &axis)
    {
      if (examples == nullptr)
        return nullptr;
      return std::make_unique<ExampleWeights>(parameters.examples, *examples, energy_of_unit_strain,
                                              axis);
    }

    std::unique_ptr<Mass>
    make_mass(const SceneParameters &parameters, const FESpace &fe_space, const Material &material)
    {
      if (parameters.scene != SceneKind::dynamic)
        return nullptr;
      return std::make_unique<Mass>(fe_space, material, parameters.material.mass_matrix);
    }

    std::unique_ptr<TimeIntegrator>
    make_integrator(const SceneParameters &parameters)
    {
      if (parameters.scene != SceneKind::dynamic)
        return nullptr;
      return std::make_unique<TimeIntegrator>(parameters.time);
    }

    std::vector<std::unique_ptr<PotentialTerm>>
    make_terms(const Mass           *mass,
               const TimeIntegrator *integrator,
               const Loads          *loads,
               const FESpace        &fe_space)
    {
      std::vector<std::unique_ptr<PotentialTerm>> terms;
      if (mass != nullptr)
        terms.push_back(std::make_unique<InertiaTerm>(*mass, *integrator));
      if (loads != nullptr)
        terms.push_back(std::make_unique<LoadTerm>(*loads, fe_space.rest_positions()));
      return terms;
    }

    std::vector<PotentialTerm *>
    pointers_to(const std::vector<std::unique_ptr<PotentialTerm>> &terms)
    {
      std::vector<PotentialTerm *> pointers;
      for (const auto &term : terms)
        pointers.push_back(term.get());
      return pointers;
    }

    /// The pattern that cells and terms need together.
    SymmetricPattern
    make_common_pattern(const FESpace                                     &fe_space,
                        const FreeDofs                                    &free_dofs,
                        const std::vector<std::unique_ptr<PotentialTerm>> &terms)
    {
      std::vector<std::pair<unsigned int, unsigned int>> couplings;
      for (const auto &term : terms)
      {
        const auto more = term->couplings();
        couplings.insert(couplings.end(), more.begin(), more.end());
      }
      SymmetricPattern pattern = make_pattern(fe_space, couplings, free_dofs);
      for (const auto &term : terms)
        term->attach(pattern, free_dofs);
      return pattern;
    }

    /// Operations of CHOLMOD's factorisation, for each degree of freedom and solve with it,
    /// from which conjugate gradients are faster: measured, doc/speed.md.
    constexpr double operations_at_crossover = 4e5;

    /// Residual of a linear solve over its right side. Newton's method and the fixed point
    /// correct the rest in their next iteration; one pass has none, and Schur complements
    /// are small differences of what these solves give.
    constexpr double tolerance_of_iterations = 1e-4, tolerance_of_last_word = 1e-8;

    /// CHOLMOD for a pattern, unless it is to be chosen and is not worth it.
    std::unique_ptr<SpdOperator>
    find_cholmod_operator(const SolverParameters &solver,
                          const unsigned int      n_columns,
                          const SymmetricPattern &pattern)
    {
      if (solver.linear_solver == LinearSolver::iterative)
        return nullptr;
      const bool may_choose = solver.linear_solver == LinearSolver::automatic
                              && solver.method != Method::quasi_newton && has_iterative_operator();
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
      if (may_choose
          && matrix->traits().n_operations > operations_at_crossover * n_columns * pattern.n())
        return nullptr;
      return matrix;
    }

    std::unique_ptr<BorderedSystem>
    make_bordered_system(const SolverParameters &solver,
                         const FreeDofs         &free_dofs,
                         const ExampleWeights   *weights,
                         const SymmetricPattern &pattern)
    {
      const bool        has_weights = weights != nullptr && weights->are_unknown();
      const WeightForm *form        = has_weights ? &weights->weight_form() : nullptr;
      if (solver.linear_solver == LinearSolver::umfpack)
        return make_umfpack_system(pattern, form);
      const unsigned int n_examples = has_weights ? form->coupled.size() : 0;
      auto               matrix     = find_cholmod_operator(solver, 1 + n_examples, pattern);
      if (matrix == nullptr)
      {
        const bool is_last_word = solver.method == Method::one_pass || n_examples > 0;
        matrix = make_iterative_operator(free_dofs, is_last_word ? tolerance_of_last_word
                                                                 : tolerance_of_iterations);
        matrix->reinit(pattern);
      }
      return make_block_system(std::move(matrix), form);
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
        examples(make_examples(parameters, mesh, fe_space, material, inputs)),
        weights(
            make_weights(parameters, examples.get(), unit_energy(fe_space, material), time_axis)),
        mass(make_mass(parameters, fe_space, material)), integrator(make_integrator(parameters)),
        terms(make_terms(mass.get(), integrator.get(), loads.get(), fe_space)),
        pattern(make_common_pattern(fe_space, free_dofs, terms)),
        elastic({ parameters.model, fe_space, material, examples.get(), weights.get(), free_dofs },
                pattern),
        potential(elastic, weights.get(), pointers_to(terms), integrator.get(), free_dofs),
        system(potential,
               make_bordered_system(parameters.solver, free_dofs, weights.get(), pattern),
               clock,
               support && turns_freely() && !parameters.model.is_frozen()),
        solver(make_step_solver(parameters.solver, potential, system, handles.get(), clock)),
        diagnostics(handles.get(), loads.get(), weights.get(), mass.get(), energy_is_bounded()),
        state(initial_state(parameters.initial,
                            mesh,
                            fe_space,
                            weights.get(),
                            parameters.scene == SceneKind::dynamic,
                            inputs.poses))
  {
    if (parameters.scene == SceneKind::statics)
      check_supports();
    if (parameters.scene == SceneKind::interpolation)
      start_interpolation();
    start(state);
  }

  void
  Problem::start(State &at)
  {
    StepClock::Scope scope(clock, Part::evaluate);
    potential.leave_step();
    potential.set_time(at.time, at);
    potential.evaluate(at, RotationUse::update, evaluation);
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
    return traits_of(parameters.model.strain).turns_freely;
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
      solver->forget(); // what it remembers has not turned with the body
      start(next);
    }
    const SolveReport report
        = solver->solve(next, evaluation, time_axis.time(step), time_axis.step_size(step));
    if (!is_success(report.status))
    {
      solver->forget(); // what it remembers has seen the step that failed
      return report;
    }
    if (integrator != nullptr)
      integrator->end_step(state, next);
    if (support && turns_freely())
    {
      align(state.positions, next.positions);
      start(next);
    }
    diagnostics.add_work(state.positions, next, evaluation.gradient);
    state = std::move(next);
    return report;
  }

  void
  Problem::resume_from(const State &earlier, const std::string &solver_memory)
  {
    state = earlier;
    solver->forget();
    if (!solver_memory.empty())
    {
      std::istringstream              bytes(solver_memory);
      boost::archive::binary_iarchive archive(bytes);
      solver->load(archive);
    }
    start(state);
  }

  std::string
  Problem::solver_memory() const
  {
    std::ostringstream bytes;
    {
      boost::archive::binary_oarchive archive(bytes);
      solver->save(archive);
    }
    return bytes.str();
  }

  Conditioning
  Problem::conditioning() const
  {
    Conditioning result;
    result.matrix                           = system.bordered().traits().pivot_ratio;
    const dealii::FullMatrix<double> &schur = solver->schur_complement();
    if (schur.m() > 0)
      result.schur = condition_number(form_of_differences(schur, weights->n_per_region()));
    return result;
  }

  std::vector<std::string>
  Problem::parts(const bool present) const
  {
    const bool        has_weights   = weights != nullptr && weights->are_unknown();
    const std::string linear_solver = system.bordered().traits().name;
    const std::vector<std::pair<std::string, bool>> all
        = { { "mass matrix", mass != nullptr },
            { "second-order time scheme",
              mass != nullptr && parameters.time.scheme != TimeScheme::implicit_euler },
            { "mass damping", mass != nullptr && parameters.time.mass_damping > 0. },
            { "stiffness damping", mass != nullptr && parameters.time.stiffness_damping > 0. },
            { "handles", handles != nullptr },
            { "own support of interpolation", support.has_value() },
            { "gravity", loads != nullptr && loads->has_gravity() },
            { "loads", loads != nullptr && loads->has_named_loads() },
            { "example poses", examples != nullptr },
            { "weight block", has_weights },
            { "weights per region", examples != nullptr && parameters.examples.weights_per_region },
            { "Schur complement", has_weights && linear_solver != "umfpack" },
            { "CHOLMOD", linear_solver == "cholesky" },
            { "algebraic multigrid", linear_solver == "iterative" },
            { "UMFPACK", linear_solver == "umfpack" },
            { "quasi-Newton method", quasi_newton_memory() > 0 },
            { "frame writer", parameters.output.every > 0 } };
    std::vector<std::string> names;
    for (const auto &[name, is_there] : all)
      if (is_there == present)
        names.push_back(name);
    return names;
  }

  std::size_t
  Problem::quasi_newton_memory() const
  {
    return parameters.solver.method == Method::quasi_newton ? solver->memory_consumption() : 0;
  }

  std::size_t
  Problem::mass_memory() const
  {
    if (mass == nullptr)
      return 0;
    std::size_t bytes = mass->memory_consumption() + integrator->memory_consumption();
    for (const auto &term : terms)
      bytes += term->memory_consumption();
    return bytes;
  }

  std::vector<std::pair<std::string, std::size_t>>
  Problem::memory_of_parts() const
  {
    std::vector<std::pair<std::string, std::size_t>> parts
        = { { "mesh", mesh.memory_consumption() },
            { "cells", fe_space.memory_consumption() + elastic.memory_consumption() },
            { "mass matrix", mass_memory() },
            { "example poses", examples == nullptr ? 0 : examples->memory_consumption() },
            { "weight block", system.memory_of_weights() },
            { "quasi-Newton method", quasi_newton_memory() } };
    if (const std::size_t bytes = system.bordered().traits().bytes; bytes > 0)
      parts.emplace_back("linear solver", bytes);
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
    {
      all.insert(all.end(), examples->get_warnings().begin(), examples->get_warnings().end());
      all.insert(all.end(), weights->get_warnings().begin(), weights->get_warnings().end());
    }
    return all;
  }

  bool
  Problem::energy_is_bounded() const
  {
    const bool has_one_energy
        = examples == nullptr || (weights->are_unknown() && !parameters.model.is_frozen());
    return integrator != nullptr && integrator->is_undamped_implicit_euler() && has_one_energy;
  }

  bool
  Problem::is_unloaded() const
  {
    if (parameters.scene != SceneKind::statics || loads != nullptr
        || (weights != nullptr && !weights->are_unknown()))
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
    if (const unsigned int inverted = evaluation.elastic.inverted_cells)
      all.push_back(
          std::to_string(inverted)
          + " cells are inverted at the end. The state is an equilibrium, but there may be "
            "one of less energy: look at the frames, or take smaller steps.");
    // strains of 1e-4 are no accident
    if (is_unloaded() && evaluation.elastic.energy > 1e-8 * unit_energy(fe_space, material))
      all.push_back(
          "Nothing loads the body, but it has come to rest in a local minimum of its energy "
          "at "
          + shortest_text(evaluation.elastic.energy)
          + " J, where the rest pose has less: Initial/Pose may be too far from it.");
    return all;
  }
} // namespace Exemplar
