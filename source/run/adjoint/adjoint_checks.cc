// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/adjoint_checks.h>
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/laws_with_derivatives.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    void
    refuse(const std::string &what, const std::string &remedy)
    {
      throw UserError(fmt::format("There are no gradients {} yet. {}", what, remedy));
    }

    void
    require_known_model(const Problem &problem)
    {
      const LawsOfCells laws = laws_of_cells(problem.parameters, problem.body);
      for (const CellLaw law : laws.present())
        if (traits_of(law).n_history > 0)
          refuse(
              fmt::format("of cells that are {}, as what they have become depends on the whole way "
                          "to the equilibrium",
                          traits_of(law).name),
              fmt::format("Set Material/{} to 0.", traits_of(law).chosen_by[0]));
        else if (!law_has_potential(law))
          refuse(
              fmt::format("of cells that are {}, as their forces are the derivative of no energy",
                          traits_of(law).name),
              "Set Model/Gradient = consistent.");
    }

    void
    require_known_examples(const Problem &problem)
    {
      if (problem.body.material.has_elasticity_of_examples() && has_orthotropic_cells(problem))
        refuse("of examples with an elasticity of their own in an orthotropic body",
               "Leave out Examples/Example modulus and Example Poisson ratio.");
    }

    void
    require_known_way(const Problem &problem)
    {
      if (problem.examples.weights.get_memory().yields() && problem.state.step > 1)
        refuse("of weights that remember, as what they have become depends on the whole way to the "
               "equilibrium",
               "Take one increment, or set Examples/Yield to 0.");
    }

    void
    refuse_steps(const std::string &what, const std::string &remedy)
    {
      throw UserError(
          fmt::format("vjp: there are no gradients through steps {} yet. {}", what, remedy));
    }

    /// The residual tolerance of the steps.
    double
    required_residual(const SolverParameters &solver)
    {
      return solver.method == Method::quasi_newton
                 ? std::max(solver.tolerance, solver.step_tolerance)
                 : solver.tolerance;
    }

    /// Of a step. What friction has not settled shows in gradients many times enlarged.
    double
    allowed_residual(const Problem &problem)
    {
      const double required = required_residual(problem.parameters.solver);
      return has_friction(problem) ? std::max(
                 1e-9, 10. * std::max(required, problem.actions.obstacles->lag_tolerance))
                                   : std::max(1e-6, 10. * required);
    }

    void
    require_known_shell(const Problem &problem)
    {
      if (problem.actions.obstacles != nullptr)
        refuse("of shells beside obstacles, which push at half of the thickness",
               "Leave out Obstacles/Names.");
      if (problem.body.material.volume_stiffness() > 0.)
        refuse("of shells with a Volume stiffness", "Set Material/Volume stiffness to 0.");
    }

    /// Throws UserError, by name, for terms of the potential that derivatives_of_slope() does not
    /// know.
    void
    require_known_potential(const Problem &problem)
    {
      if (problem.body.exchange().n_processes() > 1)
        refuse("for several processes", "Use one.");
      if (problem.body.mesh.is_shell())
        require_known_shell(problem);
      for (const auto &term : problem.potential.get_terms())
        if (const NoGradients none = term->no_gradients(); !none.what.empty())
          refuse(none.what, none.remedy);
      require_known_model(problem);
      require_known_examples(problem);
    }
  } // namespace

  bool
  has_orthotropic_cells(const Problem &problem)
  {
    for (unsigned int cell = 0; cell < problem.body.mesh.n_cells(); ++cell)
      if (problem.body.material.of_body_alone(cell).whole.orthotropic)
        return true;
    return false;
  }

  bool
  has_friction(const Problem &problem)
  {
    return problem.actions.obstacles != nullptr && problem.actions.obstacles->have_friction();
  }

  void
  require_known_scene(const Problem &problem)
  {
    if (problem.parameters.scene != SceneKind::statics)
      refuse("of scenes that are not static",
             "Set Scene = static, or record the steps: with problem.record() as trajectory.");
    require_known_potential(problem);
    require_known_way(problem);
    if (has_friction(problem))
      refuse(
          "of single equilibria with friction, as that depends on where the body has slipped from",
          "Record the steps: with problem.record() as trajectory.");
  }

  void
  require_rotations(const Problem &problem)
  {
    const FESpace    &fe_space = problem.body.fe_space;
    const LawsOfCells laws     = laws_of_cells(problem.parameters, problem.body);
    if (fe_space.is_shell())
      return; // a triangle has a rotation wherever it has an area
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int cell = fe_space.cell_of(point);
      if (!traits_of(laws[cell]).has_rotations)
        continue;
      const Matrix3<double> F = fe_space.deformation_gradient(point, problem.state.positions);
      const Matrix3<double> S = symmetric_part(transpose_times(closest_rotation(F), F));
      if (!(product_of_sums(S) > 1e-9 * std::pow(contract(F, F), 1.5)))
        throw UserError(
            fmt::format("Cell {}, counted from 0, is so deformed that its rotation is not "
                        "unique, where its "
                        "energy has no derivative. Deform the body less, or refine the mesh there.",
                        cell));
    }
  }

  void
  require_equilibrium(const Problem &problem, const Evaluation &evaluation)
  {
    const Residual residual = problem.potential.residual(problem.state, evaluation);
    const double   bound    = std::max(1e-6, 10. * problem.parameters.solver.tolerance);
    const double   value    = std::max(residual.positions, residual.weights);
    if (problem.state.step == 0 || !(value <= bound))
      throw UserError(fmt::format(
          "vjp: the problem does not stand at an equilibrium that a step has found (residual "
          "{:.2g}, "
          "allowed {:.2g}). Call step() first, after each change of the problem; run() makes no "
          "step at the scene's end.",
          value, bound));
  }

  void
  require_known_steps(const Problem &problem)
  {
    if (problem.parameters.scene == SceneKind::interpolation)
      refuse_steps("of interpolations", "Set Scene = static or dynamic.");
    if (problem.parameters.solver.method == Method::one_pass)
      refuse_steps("of one pass", "Set Solver/Method = auto.");
    if (problem.examples.weights.get_memory().in_use())
      refuse_steps("of weights that remember", "Set Examples/Yield and Creep viscosity to 0.");
    if (problem.constraints.handles.have_times())
      refuse_steps("with handles that let go or catch", "Leave out From and Until of Handles.");
    require_known_potential(problem);
  }

  void
  require_solved_step(const Problem &problem, const Evaluation &evaluation, const unsigned int step)
  {
    const double   bound    = allowed_residual(problem);
    const Residual residual = problem.potential.residual(problem.state, evaluation);
    const double   value    = std::max(residual.positions, residual.weights);
    if (!(value <= bound))
      throw UserError(fmt::format("vjp: step {}, counted from 0, ends in no equilibrium of its "
                                  "forces (residual {:.2g}, allowed {:.2g}). Lower {}.",
                                  step, value, bound,
                                  has_friction(problem)
                                      ? "Solver/Step tolerance, Tolerance, or Obstacles/Lag "
                                        "tolerance"
                                      : "Solver/Step tolerance, or Tolerance"));
  }
} // namespace Exemplar
