// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/potential/body_contact_term.h>
#include <exemplar/potential/fibre_tension_term.h>
#include <exemplar/potential/inertia_term.h>
#include <exemplar/potential/load_term.h>
#include <exemplar/potential/obstacle_term.h>
#include <exemplar/potential/shell_body.h>
#include <exemplar/potential/tie_term.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/run/problem/problem_parts.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    bool
    is_dynamic(const SceneParameters &parameters)
    {
      return parameters.scene == SceneKind::dynamic;
    }

    /// With many examples, iterations are bound by reading their strains, so that steps solved to
    /// no more than single precision store them in it.
    ExampleParameters
    example_parameters(const SceneParameters &parameters)
    {
      constexpr std::size_t many     = 8;
      constexpr double      rounding = 1e-5; // a hundred times that of single precision
      ExampleParameters     examples = parameters.examples;
      examples.in_single_precision   = parameters.solver.method == Method::quasi_newton
                                     && parameters.solver.step_tolerance >= rounding
                                     && examples.n_examples() >= many;
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

    std::unique_ptr<BodyContacts>
    make_body_contacts(const SceneParameters &parameters,
                       const Body            &body,
                       const BodyInputs      &inputs)
    {
      if (parameters.contact.empty())
        return nullptr;
      if (body.exchange().n_processes() > 1)
        throw UserError(
            parameters.name
            + ": Contact/Self and Contact/Bodies are not for several processes yet, of which "
              "none knows the surface of another. Start one.");
      if (!parameters.contact.self && body.mesh.n_pieces() == 1)
        throw UserError(
            parameters.name
            + ": Contact/Bodies = true keeps pieces of the mesh out of each other, but it is "
              "in one piece. Set Contact/Self = true, or Contact/Bodies = false.");
      auto contacts  = std::make_unique<BodyContacts>(parameters.contact, body.mesh, body.fe_space,
                                                     inputs.fields.nodes);
      contacts->tied = body.ties.pieces_of_nodes();
      return contacts;
    }

    /// Whether steps minimise one energy, the same before and after a step.
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
      if (!examples.elasticity().is_own())
        return of_body;
      return of_body.with_examples(examples.elasticity(), examples.importance);
    }
  } // namespace

  namespace
  {
    std::vector<ShellSection>
    sections_of(const std::vector<double> &thicknesses,
                const Material            &material,
                const ShellKind            kind)
    {
      std::vector<ShellSection> sections;
      for (unsigned int cell = 0; cell < thicknesses.size(); ++cell)
        sections.push_back({ thicknesses[cell], shell_elasticity(material, cell, kind) });
      return sections;
    }

    Ties
    make_ties(const SceneParameters &parameters,
              const Mesh            &mesh,
              const FESpace         &fe_space,
              const NamedNodes      &named)
    {
      if (!parameters.ties.empty() && mesh.exchange().n_processes() > 1)
        throw UserError(parameters.name
                        + ": Ties are not for several processes yet, of which none knows the "
                          "pieces of another. Start one, or leave Ties/Names empty.");
      return { parameters.ties, mesh, fe_space, named };
    }
  } // namespace

  namespace
  {
    /// The planes in which handles hold slopes: those that hold one component.
    std::vector<SymmetryPlane>
    planes_of(const SceneParameters &parameters, const Mesh &mesh, const NamedNodes &named)
    {
      std::vector<SymmetryPlane> planes;
      for (const HandleParameters &handle : parameters.handles)
        if (const std::string component = trim(handle.components);
            handle.holds_slopes() && component.size() == 1)
          if (const std::size_t axis = std::string("xyz").find(component);
              axis != std::string::npos)
            planes.push_back(
                { handle.select.nodes(mesh, "Handles/" + handle.name + "/Select", named),
                  static_cast<unsigned int>(axis) });
      return planes;
    }
  } // namespace

  Body::Body(const SceneParameters &parameters, BodyInputs &inputs)
      : mesh(std::move(inputs.mesh)),
        material(make_material(parameters.examples, std::move(inputs.fields.material))),
        fe_space(mesh.is_shell() ? FESpace(
                     mesh,
                     sections_of(inputs.fields.thicknesses, material, parameters.model.shell),
                     parameters.model.shell,
                     planes_of(parameters, mesh, inputs.fields.nodes))
                                 : FESpace(mesh, parameters.model.element)),
        ties(make_ties(parameters, mesh, fe_space, inputs.fields.nodes)),
        patches(inputs.fields.patches, fe_space, material),
        cell_material(patches.rest_of(material)), made(inputs.undivided.made),
        geo_walls(inputs.undivided.geo_walls), warnings(inputs.undivided.warnings),
        surface(inputs.undivided.surface), carried(std::move(inputs.undivided.carried)),
        inputs(inputs.undivided.inputs), weight_regions(inputs.undivided.weight_regions)
  {
  }

  void
  Body::follow_material()
  {
    patches.set_material(fe_space, material);
    cell_material = patches.rest_of(material);
  }

  Examples::Examples(const SceneParameters &parameters,
                     const Body            &body,
                     const TimeAxis        &axis,
                     const BodyInputs      &inputs)
      : poses(example_parameters(parameters),
              laws_of_cells(parameters, body),
              body.mesh,
              body.fe_space,
              body.cell_material,
              body.patches,
              inputs.fields.poses,
              inputs.fields.shares),
        weights(parameters.examples,
                poses,
                unit_energy_of_examples(body.fe_space, body.material),
                axis,
                inputs.fields.weights)
  {
  }

  Actions::Actions(const SceneParameters &parameters, const Body &body, const BodyInputs &inputs)
      : loads(make_loads(parameters, body, inputs)),
        mass(is_dynamic(parameters) ? std::make_unique<Mass>(
                 body.fe_space, body.material, parameters.material.mass_matrix)
                                    : nullptr),
        integrator(is_dynamic(parameters) ? std::make_unique<TimeIntegrator>(parameters.time)
                                          : nullptr),
        obstacles(parameters.obstacles.empty()
                      ? nullptr
                      : std::make_unique<Obstacles>(
                          parameters.obstacles, body.mesh.diameter(), inputs.fields.obstacles)),
        body_contacts(make_body_contacts(parameters, body, inputs)),
        contact_surface(obstacles == nullptr && body_contacts == nullptr
                            ? nullptr
                            : std::make_unique<ContactSurface>(body.mesh, body.fe_space)),
        notes(body.ties.get_notes()),
        energy_is_bounded(integrator != nullptr && integrator->is_undamped_implicit_euler()
                          && has_one_energy(parameters))
  {
  }

  namespace
  {
    /// The law that a cell's constants select, else `law`.
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

  ElasticParts
  elastic_parts(const SceneParameters &parameters,
                const Body            &body,
                const ExamplePoses    &poses,
                ExampleWeights        &weights,
                const FreeDofs        &free_dofs)
  {
    return { laws_of_cells(parameters, body),
             body.fe_space,
             body.material,
             body.cell_material,
             body.patches,
             poses,
             weights,
             free_dofs,
             parameters.solver.n_threads };
  }

  std::unique_ptr<ElasticBody>
  make_elastic_body(const SceneParameters &parameters,
                    const Body            &body,
                    const ExamplePoses    &poses,
                    ExampleWeights        &weights,
                    const FreeDofs        &free_dofs)
  {
    if (body.mesh.is_shell())
      return std::make_unique<ShellBody>(
          ShellParts{ body.fe_space.shell(), body.fe_space, body.material, poses,
                      poses.get_strains(), poses.get_volumes(), poses.get_dilatations(), weights,
                      free_dofs, parameters.solver.n_threads });
    return std::make_unique<ElasticPotential>(
        elastic_parts(parameters, body, poses, weights, free_dofs));
  }

  PotentialTerms
  Actions::make_terms(const Body           &body,
                      ElasticBody          *elastic,
                      const TimeIntegrator *integrator_of_terms) const
  {
    PotentialTerms terms;
    if (mass != nullptr)
      terms.push_back(
          std::make_unique<InertiaTerm>(*mass, *integrator_of_terms, energy_is_bounded));
    if (loads != nullptr)
      terms.push_back(std::make_unique<LoadTerm>(*loads, body.fe_space));
    if (obstacles != nullptr)
      terms.push_back(std::make_unique<ObstacleTerm>(*obstacles, *contact_surface, body.material,
                                                     body.fe_space.rest_positions(),
                                                     integrator_of_terms));
    if (body_contacts != nullptr)
      terms.push_back(std::make_unique<BodyContactTerm>(*body_contacts, *contact_surface,
                                                        body.material, integrator_of_terms));
    if (!body.ties.empty())
      terms.push_back(std::make_unique<TieTerm>(body.ties, body.material));
    if (!body.material.tensions().sources.empty())
      terms.push_back(
          std::make_unique<FibreTensionTerm>(body.material, body.fe_space, held_tensions));
    if (!initial_stresses.empty())
      terms.push_back(std::make_unique<InitialStressTerm>(
          dynamic_cast<ElasticPotential &>(*elastic).get_field(), body.fe_space, initial_stresses));
    return terms;
  }
} // namespace Exemplar
