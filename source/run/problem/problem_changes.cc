// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/plain_name.h>
#include <exemplar/potential/contact_clearance.h>
#include <exemplar/potential/fibre_tension_term.h>
#include <exemplar/potential/load_term.h>
#include <exemplar/potential/obstacle_term.h>
#include <exemplar/run/problem/obstacle_start.h>
#include <exemplar/run/problem/problem.h>

#include <fmt/core.h>

#include <cmath>
#include <utility>

// Changes of a problem between its steps, and the updates that follow.

namespace Exemplar
{
  namespace
  {
    /// What has changed, and parts of a problem follow.
    enum Change : unsigned int
    {
      nothing        = 0,
      new_density    = 1,
      new_elasticity = 2,
      new_examples   = 4, ///< poses or importance
      new_handles    = 8,
      new_loads      = 16,
      new_terms      = 32,
      new_damping    = 64,
      new_obstacles  = 128
    };

    void
    refuse_interpolation(const SceneParameters &scene, const std::string &what)
    {
      if (scene.scene == SceneKind::interpolation)
        throw UserError(scene.name + ": an interpolation has no " + what);
    }
  } // namespace

  void
  Problem::refresh(const unsigned int changed)
  {
    const unsigned int new_energy = new_density | new_elasticity | new_examples;
    if (changed & new_energy)
      body.follow_material();
    if (changed & new_density && actions.mass != nullptr)
      actions.mass->set_material(body.fe_space, body.material);
    if (changed & new_density && actions.loads != nullptr)
      actions.loads->set_gravity(parameters.loads.gravity, body.fe_space, body.material);
    if (changed & new_elasticity)
      examples.poses.set_material(body.cell_material, body.patches);
    if (changed & new_examples)
      examples.poses.set_parameters(parameters.examples.importance, body.cell_material,
                                    body.patches);
    if (changed & new_energy)
    {
      examples.weights.set_parameters(parameters.examples,
                                      unit_energy_of_examples(body.fe_space, body.material));
      potential.follow_parameters();
      if (lab != nullptr)
        lab->follow_parameters();
    }
    if (changed & new_obstacles)
      potential.follow_parameters();
    if (changed & (new_terms | new_obstacles))
      lab.reset();
    if (changed & (new_handles | new_terms))
      potential.get_tangent().renew_pattern();
    if (changed & ~new_loads)
      solver->forget(); // its memory is of another matrix
    if (changed & (new_energy | new_loads | new_terms | new_obstacles))
      start(state);
  }

  void
  Problem::count_change(const std::string &what)
  {
    changes.count(what);
    restart_audit(what);
  }

  void
  Problem::change_handles(const std::function<void(Handles &)> &change)
  {
    refuse_interpolation(parameters, "handles to change.");
    constraints.change_handles(change, parameters, body);
    count_change("grab() or let_go()");
    follow_slopes();
    refresh(new_handles);
  }

  void
  Problem::follow_time(const double time)
  {
    if (!constraints.follow_time(time, parameters, body))
      return;
    restart_audit("handles catch or release (From, Until)");
    follow_slopes();
    refresh(new_handles);
  }

  void
  Problem::hold_slopes_as_in(const unsigned int step)
  {
    if (constraints.follow_time(time_axis.time(step), parameters, body))
      refresh(new_handles);
    slopes_held = constraints.held_tips;
  }

  void
  Problem::follow_slopes()
  {
    const HeldTips &held = constraints.held_tips;
    if (held == slopes_held)
      return;
    const Vector tips
        = body.fe_space.with_tips(std::move(state.positions), slopes_held, state.history);
    state.positions = body.fe_space.with_slopes(tips, held, state.history);
    for (unsigned int dof = 3 * body.fe_space.numbering().n_places(); dof < state.velocities.size();
         ++dof)
      state.velocities[dof] = 0.; // slopes have no mass
    slopes_held = held;
  }

  void
  Problem::set_material(const ChangedConstants &changed)
  {
    body.material = body.material.with(changed);
    count_change("set_material()");
    const bool has_same_elasticity
        = changed.youngs_modulus.empty() && changed.poissons_ratio.empty();
    refresh((changed.density.empty() ? nothing : new_density)
            | (has_same_elasticity ? nothing : new_elasticity));
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
    count_change("importance");
    parameters.examples.importance = importance;
    if (body.material.has_elasticity_of_examples())
      body.material = body.material.with_examples(parameters.examples.elasticity(), importance);
    refresh(new_examples);
  }

  void
  Problem::check_energy(const ExampleEnergy energy) const
  {
    if (examples.poses.size() == 0 || parameters.scene == SceneKind::interpolation)
      throw UserError(parameters.name
                      + ": only a static or dynamic scene with examples has an energy of examples "
                        "to change. Give Examples/Poses and an Importance above 0.");
    SceneParameters changed = parameters;
    changed.examples.energy = energy;
    CompleteScene(std::move(changed)); // checks the combination
  }

  void
  Problem::set_energy(const ExampleEnergy energy)
  {
    check_energy(energy);
    changes.count("energy");
    parameters.examples.energy = energy;
    refresh(new_examples);
  }

  void
  Problem::hold_weights(const std::vector<double> &weights)
  {
    examples.weights.hold(weights);
    count_change("hold_weights()");
  }

  void
  Problem::require_loads()
  {
    refuse_interpolation(parameters, "loads. Set Scene = static or dynamic.");
    std::unique_ptr<Loads> &loads = actions.loads;
    if (loads != nullptr)
      return;
    loads = std::make_unique<Loads>(parameters.loads, body.mesh, body.fe_space, body.material,
                                    NamedNodes(), parameters.material.mass_matrix);
    potential.add_term(std::make_unique<LoadTerm>(*loads, body.fe_space));
    lab.reset(); // has no such term
  }

  void
  Problem::set_gravity(const std::array<double, 3> &acceleration)
  {
    require_loads();
    count_change("gravity");
    actions.loads->set_gravity(acceleration, body.fe_space, body.material);
    parameters.loads.gravity = acceleration;
    refresh(new_loads);
  }

  void
  Problem::set_nodal_forces(Vector forces)
  {
    require_loads();
    count_change("nodal_forces");
    actions.loads->set_nodal_forces(std::move(forces));
    refresh(new_loads);
  }

  void
  Problem::set_tension(std::vector<double> tensions)
  {
    const FibreTensions &of_material = body.material.tensions();
    const std::string    key         = "Material/Fibre tension";
    if (of_material.sources.empty() && !tensions.empty())
      throw UserError(
          parameters.name + ": no material has a " + key
          + ", so nobody knows which fibres are active. Set it in the scene, such as 1, and "
            "Material/Fibre direction.");
    const std::size_t n = of_material.of_cells.size();
    if (tensions.size() == 1)
    {
      const double value = tensions[0];
      tensions.assign(n, 0.);
      for (std::size_t cell = 0; cell < n; ++cell)
        tensions[cell] = of_material.of_cells[cell] > 0 ? value : 0.;
    }
    if (!tensions.empty() && tensions.size() != n)
      throw UserError(
          fmt::format("{}: there are {} numbers for {} cells. Give one for all, or one a cell.",
                      key, tensions.size(), n));
    for (std::size_t cell = 0; cell < tensions.size(); ++cell)
      if (const double T = tensions[cell]; !(T >= 0. && std::isfinite(T)))
        throw UserError(fmt::format(
            "{}: cell {}, counted from 0, would get {} Pa, but fibres do not push. Give at "
            "least 0.",
            key, cell, short_text(T)));
      else if (T > 0. && of_material.of_cells[cell] == 0)
        throw UserError(fmt::format(
            "{}: cell {}, counted from 0, has no active fibres, which the scene says. Give 0 "
            "there.",
            key, cell));
    actions.held_tensions = std::move(tensions);
    restart_audit("tension");
    refresh(new_loads);
  }

  unsigned int
  Problem::check_tension(const std::string &region, const double tension) const
  {
    const auto  &sources = body.material.tensions().sources;
    std::string  names;
    unsigned int found = 0;
    for (; found < sources.size() && sources[found].region() != region; ++found)
      names += (names.empty() ? "" : ", ") + sources[found].region();
    if (found == sources.size())
      throw UserError("Material/Fibre tension: there are no active fibres in the region '" + region
                      + "'. Allowed: " + (names.empty() ? "none" : names) + ".");
    if (!(tension >= 0. && std::isfinite(tension)))
      throw UserError("Material/Fibre tension: '" + region + "' would get " + short_text(tension)
                      + " Pa, but fibres do not push. Give at least 0.");
    return found;
  }

  void
  Problem::set_tension(const std::string &region, const double tension)
  {
    const FibreTensions &all = body.material.tensions();
    const unsigned int   law = check_tension(region, tension) + 1;
    if (actions.held_tensions.empty())
      actions.held_tensions.assign(all.of_cells.size(), FibreTensionTerm::not_held);
    restart_audit("tension");
    for (std::size_t cell = 0; cell < all.of_cells.size(); ++cell)
      if (all.of_cells[cell] == law)
        actions.held_tensions[cell] = all.factors.empty() ? tension : tension * all.factors[cell];
    refresh(new_loads);
    solver->forget(); // a resumed session could not make the factor of another tension again
  }

  void
  Problem::add_term(const MakeTerm &make)
  {
    refuse_interpolation(parameters, "terms of one's own. Set Scene = static or dynamic.");
    std::unique_ptr<PotentialTerm> term = make();
    count_change("add_term()");
    actions.own_terms.push_back({ make, term.get() });
    potential.add_term(std::move(term));
    refresh(new_terms);
  }

  std::unique_ptr<Obstacles>
  Problem::make_obstacle(const ObstacleParameters &obstacle, const ObstacleSurface &surface) const
  {
    require_plain_name(obstacle.name, "Obstacle");
    CompleteScene changed = parameters;
    for (const ObstacleParameters &other : changed.obstacles.named)
      if (other.name == obstacle.name)
        throw UserError("There is an obstacle of the name '" + obstacle.name
                        + "' already. Give another name.");
    changed.obstacles.named = { obstacle };
    changed.check_obstacles();
    return std::make_unique<Obstacles>(changed.obstacles, body.mesh.diameter(),
                                       PieceSizes(body.mesh, body.fe_space),
                                       ObstacleSurfaces{ { obstacle.name, surface } });
  }

  void
  Problem::append_obstacle(const ObstacleParameters &obstacle, std::unique_ptr<Obstacles> added)
  {
    if (actions.contact_surface == nullptr)
      actions.contact_surface = std::make_unique<ContactSurface>(body.mesh, body.fe_space);
    count_change("add_obstacle()");
    parameters.obstacles.named.push_back(obstacle);
    parameters = with_factor_beside_barriers(std::move(parameters));
    if (actions.obstacles != nullptr)
    {
      actions.obstacles->all.push_back(std::move(added->all[0]));
      actions.obstacles->start_widths.push_back(std::move(added->start_widths[0]));
      refresh(new_obstacles);
      return;
    }
    actions.obstacles = std::move(added);
    PotentialTerms terms;
    actions.append_obstacle_terms(body, actions.integrator.get(), terms);
    for (auto &term : terms)
      potential.add_term(std::move(term));
    refresh(new_terms);
  }

  void
  Problem::add_obstacle(const ObstacleParameters &obstacle, const ObstacleSurface &surface)
  {
    // apart from the others, so that nothing is changed if it is refused
    auto added = make_obstacle(obstacle, surface);
    if (actions.contact_surface == nullptr)
      actions.contact_surface = std::make_unique<ContactSurface>(body.mesh, body.fe_space);
    try
    {
      check_obstacle_motions(*added, body, time_axis);
      suit_obstacles(*added, *actions.contact_surface, body, state.positions, state.time,
                     actions.notes);
    }
    catch (const SolverFailure &failure) // of a formula
    {
      throw UserError(failure.what());
    }
    append_obstacle(obstacle, std::move(added));
  }

  void
  Problem::put_obstacle(const ObstacleParameters &obstacle)
  {
    append_obstacle(obstacle, make_obstacle(obstacle, {}));
  }

  bool
  Problem::is_clear(const ObstacleParameters &obstacle) const
  {
    const auto           added = make_obstacle(obstacle, {});
    const ContactSurface surface(body.mesh, body.fe_space);
    StandingObstacle     now(added->all[0]);
    now.move_to(state.time);
    const Clearance room
        = clearance(surface, *added, now, 0, state.positions, added->width, body.exchange());
    return !room.is_crossed && room.least >= added->width;
  }

  Obstacle &
  Problem::find_obstacle(const std::string &name)
  {
    if (actions.obstacles != nullptr)
      for (Obstacle &obstacle : actions.obstacles->all)
        if (obstacle.name() == name && !obstacle.has_left())
          return obstacle;
    throw UserError("There is no obstacle '" + name + "'.");
  }

  void
  Problem::carry_obstacle(const std::string  &name,
                          const SpaceVector3 &displacement,
                          const double        step_size)
  {
    find_obstacle(name).carry(displacement, state.time, state.time + step_size);
    count_change("carry_obstacle()");
  }

  void
  Problem::remove_obstacle(const std::string &name)
  {
    find_obstacle(name).leave();
    count_change("remove_obstacle()");
    refresh(new_obstacles);
  }

  Laboratory &
  Problem::laboratory()
  {
    if (body.mesh.is_shell())
      throw UserError(parameters.name
                      + ": energies and derivatives at given places are not for shells (Mesh/Kind) "
                        "yet. Take what "
                        "steps give.");
    if (lab == nullptr)
      lab = std::make_unique<Laboratory>(*this);
    return *lab;
  }

  void
  Problem::set_pose(const unsigned int i, const std::vector<dealii::Point<3>> &places)
  {
    const bool has_rest = parameters.examples.has_rest_pose();
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
    count_change("set_pose()");
    const auto change_to = [&](const std::vector<dealii::Point<3>> &pose)
    {
      examples.poses.set_pose(i, pose);
      refresh(new_examples);
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
    count_change("mass_damping or stiffness_damping");
    actions.integrator->set_damping(mass_damping, stiffness_damping);
    refresh(new_damping);
    parameters.time.mass_damping      = mass_damping;
    parameters.time.stiffness_damping = stiffness_damping;
  }
} // namespace Exemplar
