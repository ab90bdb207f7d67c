// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/adjoint_checks.h>
#include <exemplar/run/adjoint/certificate.h>
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/functional.h>

#include <fmt/core.h>

#include <algorithm>
#include <regex>

namespace Exemplar
{
  namespace
  {
    const std::string key = "Output/Functional";

    [[noreturn]] void
    fail(const std::string &name, const std::string &why)
    {
      throw UserError(fmt::format(
          "{} = '{}' is not allowed: {} Allowed: energy_elastic, reaction_NAME_x of a handle, or "
          "displacement_x of a selection of nodes as in Handles, such as 'displacement_z of "
          "boundary 2'; with _y and _z likewise.",
          key, name, why));
    }

    Direction
    zero_direction(const Problem &problem)
    {
      return { Vector(problem.state.positions.size()),
               std::vector<double>(problem.state.weights.size(), 0.) };
    }

    /// Psi with zero weights is the elastic energy.
    FunctionalValue
    elastic_energy(Problem &problem)
    {
      State at = problem.state;
      std::fill(at.weights.begin(), at.weights.end(), 0.);
      Evaluation evaluation;
      problem.potential.evaluate(at, RotationUse::update, evaluation);
      FunctionalValue result{ evaluation.elastic.energy_elastic, zero_direction(problem) };
      result.by_state.positions = evaluation.elastic.gradient;
      return result;
    }

    /// Derivatives of a sum of entries of dPhi/dx are those of the slope along their indicator
    /// vector.
    Functional
    reaction(const unsigned int handle, const unsigned int component)
    {
      return [=](Problem &problem)
      {
        const Handles::Holding holding = problem.constraints.handles.holding()[handle];
        Direction              held    = zero_direction(problem);
        if (std::count(holding.components.begin(), holding.components.end(), component) > 0)
          for (const unsigned int node : holding.nodes)
            held.positions[3 * node + component] = 1.;
        Evaluation evaluation;
        problem.potential.evaluate(problem.state, RotationUse::update, evaluation);
        FunctionalValue  result{ held.positions * evaluation.gradient, zero_direction(problem) };
        SlopeDerivatives slope = derivatives_of_slope(problem, ExampleStrains(problem), held);
        result.by_state        = { std::move(slope.by_positions), std::move(slope.by_weights) };
        return result;
      };
    }

    Functional
    mean_displacement(std::vector<unsigned int> nodes, const unsigned int component)
    {
      return [nodes = std::move(nodes), component](Problem &problem)
      {
        FunctionalValue result{ 0., zero_direction(problem) };
        for (const unsigned int node : nodes)
        {
          const unsigned int dof = 3 * node + component;
          result.value
              += (problem.state.positions[dof] - problem.body.fe_space.rest_positions()[dof])
                 / static_cast<double>(nodes.size());
          result.by_state.positions[dof] = 1. / static_cast<double>(nodes.size());
        }
        return result;
      };
    }

    unsigned int
    find_handle(const std::string &handle, const std::string &name, const Problem &problem)
    {
      const Handles &handles = problem.constraints.handles;
      std::string    known;
      for (unsigned int h = 0; h < handles.size(); ++h)
      {
        if (handles.name(h) == handle)
          return h;
        known += (known.empty() ? "" : ", ") + handles.name(h);
      }
      fail(name, fmt::format("no handle is called '{}' (there: {}).", handle,
                             known.empty() ? "none" : known));
    }

    std::vector<unsigned int>
    find_nodes(const std::string &text, const std::string &name, const Problem &problem)
    {
      const Selection selection{ text };
      bool            is_of_nodes = false;
      try
      {
        is_of_nodes = !selection.is_of_surface() && selection.file().empty();
      }
      catch (const UserError &) // a text that handles refuse, too
      {
      }
      if (!is_of_nodes)
        fail(name, "it has to select by box, sphere, boundary or region.");
      return selection.choose(problem.body.mesh, key);
    }
  } // namespace

  Functional
  make_functional(const std::string &name, const Problem &problem)
  {
    if (name == "energy_elastic")
      return elastic_energy;
    std::smatch parts;
    if (std::regex_match(name, parts, std::regex("reaction_(.*)_([xyz])")))
      return reaction(find_handle(parts[1], name, problem),
                      static_cast<unsigned int>(parts.str(2)[0] - 'x'));
    if (std::regex_match(name, parts, std::regex("displacement_([xyz])\\s+of\\s+(.*)")))
      return mean_displacement(find_nodes(parts[2], name, problem),
                               static_cast<unsigned int>(parts.str(1)[0] - 'x'));
    fail(name, "that is no functional.");
  }

  void
  require_functional(const Problem &problem)
  {
    const std::string &name = problem.parameters.output.functional;
    if (name.empty())
      return;
    try
    {
      require_known_scene(problem);
    }
    catch (const UserError &error)
    {
      throw UserError(key + " = '" + name + "' needs gradients. " + error.what()
                      + " Or leave it out.");
    }
    make_functional(name, problem);
  }

  std::optional<FunctionalReport>
  functional_at_end(Problem &problem)
  {
    const std::string &name = problem.parameters.output.functional;
    if (name.empty() || problem.state.step < problem.time_axis.n_steps())
      return {};
    const FunctionalValue found = make_functional(name, problem)(problem);
    FunctionalReport      report{ name, found.value, {}, {} };
    try
    {
      report.correction = correction(problem, found.by_state);
    }
    catch (const std::runtime_error &error) // UserError where a rotation is not unique
    {
      report.failure = error.what();
    }
    return report;
  }
} // namespace Exemplar
