// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/run/adjoint/adjoint_checks.h>

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
      const ModelParameters &model = problem.parameters.model;
      if (model.element != Element::P1)
        refuse("with quadratic elements", "Set Model/Element = P1.");
      const LawsOfCells laws = laws_of_cells(problem.parameters, problem.body);
      for (unsigned int cell = 0; cell < problem.body.mesh.n_cells(); ++cell)
        if (laws[cell] != CellLaw::corotational)
          refuse(
              fmt::format("of cells that are {}", traits_of(laws[cell]).name),
              "Known are those of the corotational strain with consistent forces, without fibres, "
              "nine constants, a yield stress and a neo-Hookean background.");
    }

    void
    require_known_examples(const Problem &problem)
    {
      const ExampleParameters &examples = problem.parameters.examples;
      if (problem.examples.poses.size() == 0)
        return;
      if (examples.acts_on != ActsOn::all)
        refuse("of examples that act on a part of the strain", "Set Examples/Acts on = all.");
      if (problem.body.material.has_examples())
        refuse("of examples with an elasticity of their own",
               "Leave out Examples/Example modulus and Example Poisson ratio.");
      if (problem.body.material.importance_varies())
        refuse("where the importance differs from cell to cell",
               "Leave out the Importance of regions and maps.");
      if (problem.examples.weights.get_memory().in_use())
        refuse("of weights that remember", "Set Examples/Yield and Creep viscosity to 0.");
    }
  } // namespace

  void
  require_known_scene(const Problem &problem)
  {
    if (problem.parameters.scene != SceneKind::statics)
      refuse("of scenes that are not static",
             "Set Scene = static, or record the steps: with problem.record() as trajectory.");
    if (problem.body.exchange().n_processes() > 1)
      refuse("for several processes", "Use one.");
    require_known_model(problem);
    require_known_examples(problem);
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
          "allowed {:.2g}). Call step() or run() first, after each change of the problem.",
          value, bound));
  }
} // namespace Exemplar
