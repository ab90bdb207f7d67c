// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/potential/inertia_term.h>
#include <exemplar/potential/load_term.h>
#include <exemplar/potential/patch_dilatation.h>
#include <exemplar/run/problem/problem_parts.h>

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace Exemplar
{
  namespace
  {
    bool
    is_dynamic(const SceneParameters &parameters)
    {
      return parameters.scene == SceneKind::dynamic;
    }

    /// What this process has of degrees of freedom of the whole body.
    std::vector<unsigned int>
    dofs_here(const Exchange &exchange, const std::vector<unsigned int> &in_whole)
    {
      std::vector<unsigned int> here;
      for (const unsigned int dof : in_whole)
        if (const int node = exchange.node_here(dof / 3); node >= 0)
          here.push_back(3 * static_cast<unsigned int>(node) + dof % 3);
      return here;
    }

    std::string
    names_of_selections(const std::vector<HandleParameters> &handles)
    {
      std::string names;
      for (const HandleParameters &handle : handles)
        names += (names.empty() ? "Handles/" : " or Handles/") + handle.name + "/Select";
      return names;
    }

    /// The least radius about a node [m] within which a whole cell lies.
    double
    reach_of_a_cell(const Body &body, const unsigned int node)
    {
      double minimum = std::numeric_limits<double>::max();
      for (const auto &cell : body.mesh.get_cells())
        if (std::find(cell.begin(), cell.end(), node) != cell.end())
        {
          double reach = 0.;
          for (const unsigned int corner : cell)
            reach = std::max(reach,
                             body.mesh.get_nodes()[corner].distance(body.mesh.get_nodes()[node]));
          minimum = std::min(minimum, reach);
        }
      return minimum;
    }

    std::vector<unsigned int>
    held_dofs(const SceneParameters                             &parameters,
              const Body                                        &body,
              const Handles                                     &handles,
              const std::optional<StaticallyDeterminateSupport> &support)
    {
      if (support)
        return dofs_here(body.exchange(), support->held_dofs);
      const std::vector<unsigned int> held = handles.held_dofs();
      if (!body.exchange().any(held.size() < body.fe_space.n_dofs()))
        throw UserError(parameters.name
                        + ": the handles hold every node, so there is nothing to solve. Make "
                        + names_of_selections(parameters.handles)
                        + " smaller; it counts in metres, in which the body is "
                        + short_text(body.mesh.diameter()) + " large.");
      return held;
    }

    /// Strains of many examples are what an iteration reads most of, so steps that are not solved further
    /// than the rounding of single precision take them rounded.
    ExampleParameters
    example_parameters(const SceneParameters &parameters)
    {
      constexpr std::size_t many     = 8;
      constexpr double      rounding = 1e-5; // a hundred times that of single precision
      ExampleParameters     examples = parameters.examples;
      examples.in_single_precision   = parameters.solver.method == Method::quasi_newton
                                     && parameters.solver.step_tolerance >= rounding
                                     && examples.in_use() && examples.n_examples() >= many;
      return examples;
    }

    std::unique_ptr<Loads>
    make_loads(const SceneParameters &parameters, const Body &body, const BodyInputs &inputs)
    {
      if (parameters.loads.empty())
        return nullptr;
      return std::make_unique<Loads>(parameters.loads, body.mesh, body.fe_space, body.material,
                                     inputs.fields.nodes, parameters.material.mass_matrix);
    }

    /// Whether steps descend on one energy, the same before and after a step.
    bool
    has_one_energy(const SceneParameters &parameters)
    {
      return !parameters.examples.in_use()
             || (parameters.examples.weights != WeightRule::prescribed
                 && !parameters.model.is_frozen());
    }
  } // namespace

  TimeAxis
  make_time_axis(const SceneParameters &parameters)
  {
    return is_dynamic(parameters) ? TimeAxis::of_dynamics(parameters.time)
                                  : TimeAxis::of_increments(parameters.time);
  }

  namespace
  {
    Material
    make_material(const ExampleParameters &examples, Material of_body)
    {
      if (!examples.in_use() || !examples.elasticity().is_own())
        return of_body;
      return of_body.with_examples(examples.elasticity(), examples.importance);
    }
  } // namespace

  Body::Body(const SceneParameters &parameters, BodyInputs &inputs)
      : mesh(std::move(inputs.mesh)),
        material(make_material(parameters.examples, std::move(inputs.fields.material))),
        fe_space(mesh, parameters.model.element),
        patches(inputs.fields.patches, fe_space, material),
        cell_material(patches.rest_of(material)), made(inputs.undivided.made),
        geo_walls(inputs.undivided.geo_walls), warnings(inputs.undivided.warnings)
  {
  }

  void
  Body::follow_material()
  {
    patches.set_material(fe_space, material);
    cell_material = patches.rest_of(material);
  }

  Constraints::Constraints(const SceneParameters &parameters,
                           const Body            &body,
                           const TimeAxis        &axis,
                           const BodyInputs      &inputs)
      : handles(parameters.handles,
                body.mesh,
                body.fe_space,
                axis,
                inputs.fields.poses,
                inputs.fields.nodes,
                inputs.undivided.motions),
        support(inputs.fields.support),
        free_dofs(
            body.fe_space.n_dofs(), held_dofs(parameters, body, handles, support), body.exchange())
  {
    if (body.exchange().any(free_dofs.size() == 0))
      throw UserError(fmt::format(
          "{}: of {} processes some would have no node to move. Start fewer with mpirun -n.",
          parameters.name, body.exchange().n_processes()));
  }

  namespace
  {
    /// Of a handle with a single node.
    std::string
    remedy_of_single_node(const Handles &handles, const unsigned int h, const Body &body)
    {
      const auto  &nodes = handles.nodes(h);
      const double reach
          = min_of_all(body.exchange(), nodes.empty() ? std::numeric_limits<double>::max()
                                                      : reach_of_a_cell(body, nodes[0]));
      return "Enlarge Handles/" + handles.name(h) + "/Select by " + short_text(1.01 * reach)
             + " m, and it holds a whole tetrahedron.";
    }
  } // namespace

  std::vector<std::string>
  Constraints::describe_single_nodes(const Body &body) const
  {
    std::vector<std::string> all;
    for (unsigned int h = 0; h < handles.size(); ++h)
      if (handles.n_nodes(h) == 1)
        all.push_back("Handle '" + handles.name(h)
                      + "' holds a single node, about which the body can turn. "
                      + remedy_of_single_node(handles, h, body));
    return all;
  }

  std::vector<std::string>
  Constraints::describe_pulled_nodes(const SceneParameters &parameters, const Body &body) const
  {
    const HandleParameters   usual;
    std::vector<std::string> all;
    for (unsigned int h = 0; h < parameters.handles.size(); ++h)
      if (const HandleParameters &handle = parameters.handles[h];
          handle.select.is_of_space() && handle.motion != usual.motion
          && handle.components == usual.components && handles.n_nodes(h) == 1)
        all.push_back("Handle '" + handle.name + "' pulls at the single node in its "
                      + handle.select.text
                      + ", so the strain there depends on the size of the cells. "
                      + remedy_of_single_node(handles, h, body));
    return all;
  }

  void
  Constraints::check(const SceneParameters &parameters, const Body &body) const
  {
    check_rigid_motions(parameters, body, held_dofs(parameters, body, handles, support));
  }

  void
  Constraints::change_handles(const std::function<void(Handles &)> &change,
                              const SceneParameters                &parameters,
                              const Body                           &body)
  {
    const auto holding = handles.holding();
    try
    {
      change(handles);
      const std::vector<unsigned int> held = held_dofs(parameters, body, handles, support);
      check_rigid_motions(parameters, body, held);
      free_dofs.reinit(held);
    }
    catch (const UserError &)
    {
      handles.restore(holding);
      throw;
    }
  }

  void
  Constraints::check_rigid_motions(const SceneParameters           &parameters,
                                   const Body                      &body,
                                   const std::vector<unsigned int> &held) const
  {
    if (parameters.scene != SceneKind::statics)
      return;
    const unsigned int n_free
        = n_free_rigid_motions(body.mesh, body.fe_space.rest_positions(), held);
    std::string single_nodes;
    for (const std::string &sentence : describe_single_nodes(body))
      single_nodes += " " + sentence;
    if (n_free > 0)
      throw UserError(fmt::format(
          "{}: the handles leave {} of 6 rigid motions free, so a static scene has no unique "
          "equilibrium.{}{} a subsection of Handles that holds three nodes not on a line (a box, a "
          "sphere or a boundary), or hold more Components.",
          parameters.name, n_free, single_nodes, single_nodes.empty() ? " Add" : " Or add"));
  }

  Examples::Examples(const SceneParameters &parameters,
                     const Body            &body,
                     const TimeAxis        &axis,
                     const BodyInputs      &inputs)
      : poses(example_parameters(parameters),
              parameters.model.law(),
              body.mesh,
              body.fe_space,
              body.cell_material,
              body.patches,
              inputs.fields.poses,
              inputs.fields.shares),
        weights(
            parameters.examples, poses, unit_energy_of_examples(body.fe_space, body.material), axis)
  {
  }

  Actions::Actions(const SceneParameters &parameters, const Body &body, const BodyInputs &inputs)
      : loads(make_loads(parameters, body, inputs)),
        mass(is_dynamic(parameters) ? std::make_unique<Mass>(
                 body.fe_space, body.material, parameters.material.mass_matrix)
                                    : nullptr),
        integrator(is_dynamic(parameters) ? std::make_unique<TimeIntegrator>(parameters.time)
                                          : nullptr),
        energy_is_bounded(integrator != nullptr && integrator->is_undamped_implicit_euler()
                          && has_one_energy(parameters))
  {
  }

  namespace
  {
    /// The law that its constants choose for a cell, or this one.
    CellLaw
    chosen_law(const Material &material, const unsigned int cell, CellLaw law)
    {
      for (const CellLaw other : all_laws())
      {
        const auto keys = traits_of(other).chosen_by;
        if (keys[0] != nullptr
            && std::all_of(keys.begin(), keys.end(),
                           [&](const char *const key)
                           { return key == nullptr || material.own_number(key, cell) > 0.; }))
          law = other;
      }
      return law;
    }
  } // namespace

  LawsOfCells
  laws_of_cells(const SceneParameters &parameters, const Body &body)
  {
    const CellLaw law = parameters.model.law();
    if (!parameters.material.chooses_laws())
      return law;
    std::vector<CellLaw> of_cells(body.fe_space.n_cells());
    for (unsigned int cell = 0; cell < of_cells.size(); ++cell)
      of_cells[cell] = chosen_law(body.material, cell, law);
    LawsOfCells laws(std::move(of_cells));
    for (const CellLaw other : all_laws())
    {
      const auto &here = laws.present();
      if (body.exchange().any(std::count(here.begin(), here.end(), other) > 0))
        laws.add(other);
    }
    return laws;
  }

  PotentialTerms
  make_elastic_terms(const Body &body, const Examples &examples)
  {
    PotentialTerms terms;
    if (body.patches.size() > 0)
      terms.push_back(std::make_unique<PatchDilatation>(body.patches, examples.poses, body.fe_space,
                                                        body.material));
    return terms;
  }

  PotentialTerms
  Actions::make_terms(const Body &body, const TimeIntegrator *integrator_of_terms) const
  {
    PotentialTerms terms;
    if (mass != nullptr)
      terms.push_back(
          std::make_unique<InertiaTerm>(*mass, *integrator_of_terms, energy_is_bounded));
    if (loads != nullptr)
      terms.push_back(std::make_unique<LoadTerm>(*loads, body.fe_space));
    return terms;
  }
} // namespace Exemplar
