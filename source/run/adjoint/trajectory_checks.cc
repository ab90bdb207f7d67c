// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/kernels/patch_cell.h>
#include <exemplar/run/adjoint/trajectory_checks.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    void
    refuse_steps(const std::string &what, const std::string &remedy)
    {
      throw UserError(
          fmt::format("vjp: there are no gradients through steps {} yet. {}", what, remedy));
    }

    void
    require_known_scheme(const Problem &problem)
    {
      if (problem.parameters.scene == SceneKind::interpolation)
        refuse_steps("of interpolations", "Set Scene = static or dynamic.");
      if (problem.parameters.solver.method == Method::one_pass)
        refuse_steps("of one pass", "Set Solver/Method = auto.");
      if (problem.body.exchange().n_processes() > 1)
        refuse_steps("of several processes", "Use one.");
      if (!problem.get_own_terms().empty())
        refuse_steps("with terms of one's own", "Make the problem without add_term().");
    }

    void
    require_known_cells(const Problem &problem)
    {
      if (problem.parameters.model.element != Element::P1)
        refuse_steps("with quadratic elements", "Set Model/Element = P1.");
      const LawsOfCells laws = laws_of_cells(problem.parameters, problem.body);
      for (const CellLaw law : laws.present())
        if (law != CellLaw::corotational)
          refuse_steps(
              fmt::format("of cells that are {}", traits_of(law).name),
              "Known are those of the corotational strain with consistent forces, without fibres, "
              "nine constants, a yield stress and a neo-Hookean background.");
    }

    void
    require_known_poses(const Problem &problem)
    {
      const ExampleParameters &examples = problem.parameters.examples;
      if (problem.examples.poses.size() == 0)
        return;
      if (examples.acts_on != ActsOn::all)
        refuse_steps("of examples that act on a part of the strain", "Set Examples/Acts on = all.");
      if (problem.body.material.has_elasticity_of_examples())
        refuse_steps("of examples with an elasticity of their own",
                     "Leave out Examples/Example modulus and Example Poisson ratio.");
      if (problem.body.material.importance_varies())
        refuse_steps("where the importance differs from cell to cell",
                     "Leave out the Importance of regions and maps.");
      if (problem.examples.weights.get_memory().in_use())
        refuse_steps("of weights that remember", "Set Examples/Yield and Creep viscosity to 0.");
    }
  } // namespace

  void
  require_known_steps(const Problem &problem)
  {
    require_known_scheme(problem);
    require_known_cells(problem);
    require_known_poses(problem);
  }

  void
  require_no_guard(const Problem &problem)
  {
    const FESpace      &fe_space = problem.body.fe_space;
    const Patches      &patches  = problem.body.patches;
    const double        p_0      = problem.examples.poses.constants().guard_bound;
    std::vector<double> mean_squares(patches.size(), 0.);
    const auto          refuse_cell = [](const std::string &what, const unsigned int number)
    {
      throw UserError(fmt::format(
          "{} {}, counted from 0, is so deformed that a guard of doc/model.md acts, of which "
          "gradients lack the derivatives. Deform the body less, or refine the mesh there.",
          what, number));
    };
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const Matrix3<double> F = fe_space.deformation_gradient(point, problem.state.positions);
      const Matrix3<double> S = symmetric_part(transpose_times(closest_rotation(F), F));
      Matrix3<double>       B = combine(-1., S, 0., S);
      for (int i = 0; i < 3; ++i)
        B[i][i] += trace(S);
      const double square = contract(F, F), p = determinant(B);
      if (!(p > std::max(p_0, NearKink<double>::y_0 * square)))
        refuse_cell("Cell", point);
      if (patches.size() > 0)
        mean_squares[patches.of_point(point)]
            += fe_space.volume(point) / patches.volume(patches.of_point(point)) * square;
    }
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      if (!(mean_squares[patch] < min_stretched_square))
        refuse_cell("The patch of cell", patches.points(patch).front());
  }

  double
  required_residual(const SolverParameters &solver)
  {
    return solver.method == Method::quasi_newton ? std::max(solver.tolerance, solver.step_tolerance)
                                                 : solver.tolerance;
  }

  void
  require_solved_step(const Problem &problem, const Evaluation &evaluation, const unsigned int step)
  {
    const double   bound    = std::max(1e-6, 10. * required_residual(problem.parameters.solver));
    const Residual residual = problem.potential.residual(problem.state, evaluation);
    const double   value    = std::max(residual.positions, residual.weights);
    if (!(value <= bound))
      throw UserError(fmt::format("vjp: step {}, counted from 0, ends in no equilibrium of its "
                                  "forces (residual {:.2g}, allowed {:.2g}). Lower "
                                  "Solver/Step tolerance, or Tolerance.",
                                  step, value, bound));
  }
} // namespace Exemplar
