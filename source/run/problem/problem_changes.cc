// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/potential/load_term.h>
#include <exemplar/run/problem/problem.h>

#include <fmt/core.h>

#include <utility>

// Changes of a problem between its steps, and the updates that follow.

namespace Exemplar
{
  namespace
  {
    /// Make Loads if there are none. Returns whether there were none.
    bool
    make_loads(Problem &problem)
    {
      if (problem.parameters.scene == SceneKind::interpolation)
        throw UserError(problem.parameters.name
                        + ": an interpolation has no loads. Set Scene = static or dynamic.");
      std::unique_ptr<Loads> &loads = problem.actions.loads;
      if (loads != nullptr)
        return false;
      loads = std::make_unique<Loads>(problem.parameters.loads, problem.body.mesh,
                                      problem.body.fe_space, problem.body.material, NamedNodes(),
                                      problem.parameters.material.mass_matrix);
      problem.potential.add_term(std::make_unique<LoadTerm>(*loads, problem.body.fe_space));
      return true;
    }
  } // namespace

  void
  Problem::change_handles(const std::function<void(Handles &)> &change)
  {
    if (constraints.support)
      throw UserError(parameters.name + ": an interpolation has no handles to change.");
    constraints.change_handles(change, parameters, body);
    changes.count("grab() or let_go()");
    potential.get_tangent().renew_pattern();
    solver->forget(); // its memory is of other unknowns
  }

  void
  Problem::set_material(const ChangedConstants &changed)
  {
    body.material = body.material.with(changed);
    changes.count("set_material()");
    body.follow_material();
    if (actions.mass != nullptr && !changed.density.empty())
      actions.mass->set_material(body.fe_space, body.material);
    if (actions.loads != nullptr && !changed.density.empty())
      actions.loads->set_gravity(parameters.loads.gravity, body.fe_space, body.material);
    if (!changed.youngs_modulus.empty() || !changed.poissons_ratio.empty())
      examples.poses.set_material(body.cell_material, body.patches);
    follow_parameters();
  }

  void
  Problem::check_importance(const double importance) const
  {
    if (examples.poses.size() == 0 || parameters.scene == SceneKind::interpolation)
      throw UserError(
          parameters.name
          + ": only a static or dynamic scene with examples has an importance to change. "
            "Give Examples/Poses and an Importance above 0.");
    if (!(importance > 0. && importance <= 1.))
      throw UserError("Examples/Importance: it is " + shortest_text(importance)
                      + ", but must be above 0 and at most 1.");
  }

  void
  Problem::set_importance(const double importance)
  {
    check_importance(importance);
    changes.count("importance");
    parameters.examples.importance = importance;
    if (body.material.has_elasticity_of_examples())
      body.material = body.material.with_examples(parameters.examples.elasticity(), importance);
    body.follow_material();
    examples.poses.set_parameters(importance, body.cell_material, body.patches);
    follow_parameters();
  }

  void
  Problem::hold_weights(const std::vector<double> &weights)
  {
    examples.weights.hold(weights);
    changes.count("hold_weights()");
  }

  void
  Problem::set_gravity(const std::array<double, 3> &acceleration)
  {
    if (make_loads(*this))
      lab.reset(); // has no such term
    changes.count("gravity");
    actions.loads->set_gravity(acceleration, body.fe_space, body.material);
    parameters.loads.gravity = acceleration;
    start(state);
  }

  void
  Problem::set_nodal_forces(Vector forces)
  {
    if (make_loads(*this))
      lab.reset(); // has no such term
    changes.count("nodal_forces");
    actions.loads->set_nodal_forces(std::move(forces));
    start(state);
  }

  void
  Problem::add_term(const MakeTerm &make)
  {
    if (parameters.scene == SceneKind::interpolation)
      throw UserError(parameters.name
                      + ": an interpolation has no terms of one's own. Set Scene = static or "
                        "dynamic.");
    std::unique_ptr<PotentialTerm> term = make();
    changes.count("add_term()");
    actions.own_terms.push_back({ make, term.get() });
    potential.add_term(std::move(term));
    potential.get_tangent().renew_pattern();
    solver->forget(); // its factors are of another matrix
    lab.reset();
    start(state);
  }

  Laboratory &
  Problem::laboratory()
  {
    if (lab == nullptr)
      lab = std::make_unique<Laboratory>(*this);
    return *lab;
  }

  void
  Problem::set_pose(const unsigned int i, const std::vector<dealii::Point<3>> &places)
  {
    const bool has_rest = parameters.examples.include_rest_pose;
    if (i >= examples.poses.size() || (i == 0 && has_rest))
      throw UserError(
          fmt::format("{}: there is no pose {} to set. {}", parameters.name, i,
                      examples.poses.size() == 0
                          ? "The scene has no examples: give Examples/Poses."
                          : fmt::format("Examples are counted from 0, as weights: there are {}{}.",
                                        examples.poses.size(),
                                        has_rest ? ", of which 0 is the rest pose" : "")));
    const Vector                  before = examples.poses.pose(i);
    std::vector<dealii::Point<3>> back;
    for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
      back.emplace_back(before[3 * node], before[3 * node + 1], before[3 * node + 2]);
    changes.count("set_pose()");
    const auto change_to = [&](const std::vector<dealii::Point<3>> &pose)
    {
      examples.poses.set_pose(i, pose);
      examples.poses.set_parameters(parameters.examples.importance, body.cell_material,
                                    body.patches);
      follow_parameters();
    };
    try
    {
      change_to(places);
    }
    catch (const UserError &)
    {
      change_to(back);
      throw;
    }
  }

  void
  Problem::check_damping(const double mass_damping, const double stiffness_damping) const
  {
    if (actions.integrator == nullptr)
      throw UserError(parameters.name + ": only a dynamic scene is damped. Set Scene = dynamic.");
    if (!(mass_damping >= 0. && stiffness_damping >= 0.))
      throw UserError("Time/Mass damping and Time/Stiffness damping must not be negative.");
  }

  void
  Problem::set_damping(const double mass_damping, const double stiffness_damping)
  {
    check_damping(mass_damping, stiffness_damping);
    changes.count("mass_damping or stiffness_damping");
    actions.integrator->set_damping(mass_damping, stiffness_damping);
    solver->forget(); // its memory is of other damping
    parameters.time.mass_damping      = mass_damping;
    parameters.time.stiffness_damping = stiffness_damping;
  }

  void
  Problem::follow_parameters()
  {
    examples.weights.set_parameters(parameters.examples,
                                    unit_energy_of_examples(body.fe_space, body.material));
    potential.follow_parameters();
    if (lab != nullptr)
      lab->follow_parameters();
    solver->forget(); // its factors are of other values
    start(state);
  }
} // namespace Exemplar
