// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/potential/obstacle_term.h>
#include <exemplar/run/adjoint/adjoint_checks.h>
#include <exemplar/run/adjoint/adjoint_solve.h>
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/slope_of_contact.h>
#include <exemplar/run/adjoint/slope_of_motion.h>
#include <exemplar/run/adjoint/trajectory_gradients.h>
#include <exemplar/run/problem/state_review.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>

// Backward sweep from the last step to the first, which carries the derivatives of J by the
// positions and velocities of the two states before a step, through all later steps.

namespace Exemplar
{
  namespace
  {
    /// Lets the problem stand at other states; the destructor restores its own.
    class Visit
    {
    public:
      explicit Visit(Problem &problem)
          : problem(problem), own_tensions(problem.actions.held_tensions),
            obstacles(find_obstacle_term(problem))
      {
        std::swap(own_state, problem.state); // a copy would leave views of others dangling
        if (obstacles != nullptr)
          own_step = obstacles->get_step();
      }

      Visit(const Visit &) = delete;
      Visit &
      operator=(const Visit &)
          = delete;

      ~Visit()
      {
        std::swap(own_state, problem.state);
        problem.actions.held_tensions = std::move(own_tensions);
        Evaluation evaluation; // discarded; evaluated to restore the rotations
        problem.potential.leave_step(problem.state);
        problem.potential.set_time(problem.state.time, problem.state);
        problem.potential.evaluate(problem.state, RotationUse::update, evaluation);
        if (obstacles != nullptr) // whose friction is of a step alone
          obstacles->set_step(std::move(own_step));
      }

      /// Set the state at the end of a step from `start`, and evaluate there.
      void
      go_to(const State &start, const RecordedStep &step, Evaluation &evaluation)
      {
        problem.state                 = start;
        problem.state.positions       = step.positions;
        problem.state.velocities      = step.velocities;
        problem.state.weights         = step.weights;
        problem.actions.held_tensions = step.held_tensions;
        problem.potential.begin_step(start, step.size);
        problem.potential.set_time(step.time, problem.state);
        problem.potential.evaluate(problem.state, RotationUse::update, evaluation);
        problem.potential.renew(problem.state, evaluation, true);
      }

    private:
      Problem            &problem;
      State               own_state;
      std::vector<double> own_tensions;
      ObstacleTerm       *obstacles;
      ObstacleTerm::Step  own_step;
    };

    void
    add(const std::vector<double> &numbers, std::vector<double> &to)
    {
      for (std::size_t i = 0; i < numbers.size(); ++i)
        to[i] += numbers[i];
    }

    void
    add(const SlopeDerivatives &some, SlopeDerivatives &to)
    {
      if (to.by_nodal_forces.size() == 0)
      {
        to = some;
        return;
      }
      to.by_rest_positions += some.by_rest_positions;
      to.by_nodal_forces += some.by_nodal_forces;
      for (std::size_t i = 0; i < to.by_poses.size(); ++i)
        to.by_poses[i] += some.by_poses[i];
      add(some.by_young, to.by_young);
      add(some.by_poisson, to.by_poisson);
      add(some.by_density, to.by_density);
      add(some.by_tension, to.by_tension);
      add(some.by_thickness, to.by_thickness);
      for (std::size_t cell = 0; cell < to.by_gradients.size(); ++cell)
      {
        to.by_gradients[cell] = combine(1., to.by_gradients[cell], 1., some.by_gradients[cell]);
        for (std::size_t k = 0; k < to.by_constants[cell].size(); ++k)
          to.by_constants[cell][k] += some.by_constants[cell][k];
      }
      for (std::size_t i = 0; i < to.by_strains.size(); ++i)
        for (std::size_t k = 0; k < n_symmetric; ++k)
          to.by_strains[i][k] += some.by_strains[i][k];
      to.by_importance += some.by_importance;
      for (unsigned int c = 0; c < 3; ++c)
        to.by_gravity[c] += some.by_gravity[c];
      for (std::size_t i = 0; i < to.of_obstacles.size(); ++i)
      {
        to.of_obstacles[i].by_place += some.of_obstacles[i].by_place;
        to.of_obstacles[i].by_radius += some.of_obstacles[i].by_radius;
        to.of_obstacles[i].by_coefficient += some.of_obstacles[i].by_coefficient;
      }
    }

    /// Derivatives of J by a state, through later steps.
    struct Carried
    {
      Vector positions, velocities;
    };

    class Backward
    {
    public:
      Backward(Problem                             &problem,
               const RecordedSteps                 &steps,
               const std::vector<StateDerivatives> &by_states)
          : problem(problem), steps(steps), by_states(by_states), visit(problem), system(problem),
            strains(problem), is_dynamic(problem.actions.integrator != nullptr)
      {
        for (Carried &state : carried)
          state = { zeros(), zeros() };
        find_held_nodes();
        result.handles.assign(steps.size(), std::vector<double>(3 * result.held_nodes.size(), 0.));
        if (problem.parameters.material.has_tension())
          result.tension.assign(steps.size(),
                                std::vector<double>(problem.body.fe_space.n_cells(), 0.));
      }

      TrajectoryGradients
      run()
      {
        for (unsigned int i = steps.size(); i-- > 0;)
          add_step(i);
        result.all         = gradients_of(problem, sums());
        result.all.handles = zeros();
        for (const std::vector<double> &of_step : result.handles)
          for (std::size_t i = 0; i < of_step.size(); ++i)
            result.all.handles[3 * result.held_nodes[i / 3] + i % 3] += of_step[i];
        require_finite(result.all, by_mass_damping + by_stiffness_damping
                                       + carried[0].positions.l1_norm()
                                       + carried[0].velocities.l1_norm());
        if (is_dynamic)
        {
          result.mass_damping       = -by_mass_damping;
          result.stiffness_damping  = -by_stiffness_damping;
          result.initial_velocities = std::move(carried[0].velocities);
        }
        if (is_dynamic || has_friction(problem))
          result.initial_positions = std::move(carried[0].positions);
        std::reverse(result.weakly_active.begin(), result.weakly_active.end());
        return std::move(result);
      }

    private:
      Vector
      zeros() const
      {
        return Vector(problem.body.fe_space.n_dofs());
      }

      void
      find_held_nodes()
      {
        const FreeDofs &free_dofs = problem.potential.get_free_dofs();
        const FESpace  &fe_space  = problem.body.fe_space;
        // a slope has one number, behind which there are two that nothing depends on
        const auto is_unused = [&](const unsigned int dof)
        {
          return fe_space.is_shell() && dof / 3 >= problem.body.mesh.n_nodes()
                 && free_dofs.free_index(dof / 3 * 3) != FreeDofs::held;
        };
        for (unsigned int dof = 0; dof < fe_space.n_dofs(); ++dof)
          if (free_dofs.free_index(dof) == FreeDofs::held && !is_unused(dof)
              && (result.held_nodes.empty() || result.held_nodes.back() != dof / 3))
            result.held_nodes.push_back(dof / 3);
      }

      /// If J depends on no step: zeros of the right sizes.
      SlopeDerivatives
      sums()
      {
        if (sum.by_nodal_forces.size() == 0)
          sum = derivatives_of_slope(
              problem, strains,
              { zeros(), std::vector<double>(problem.examples.poses.n_weights(), 0.) });
        return std::move(sum);
      }

      void
      add_step(const unsigned int i)
      {
        const State start = steps.start(i);
        Evaluation  evaluation;
        visit.go_to(start, steps.step(i), evaluation);
        if (evaluation.elastic.guarded_cells > 0) // rotations are unique elsewhere
          require_rotations(problem);
        require_solved_step(problem, evaluation, i);
        const std::vector<unsigned int> weak = weakly_active(problem, evaluation);
        for (auto weight = weak.rbegin(); weight != weak.rend(); ++weight)
          result.weakly_active.emplace_back(i, *weight);

        const Direction by_state = take_derivatives(i);
        if (by_state.positions.all_zero() && all_zero(by_state.weights) && by_velocities.all_zero())
        {
          carry({}, {});
          return;
        }
        system.go_to_state(evaluation);
        MotionDerivatives      of_motion;
        const SlopeDerivatives slope
            = solve_adjoint(system, by_state,
                            [&](const Direction &direction)
                            { return derivatives(start, direction, of_motion); })
                  .derivatives;
        const Vector of_handles = of_held(problem, by_state.positions, slope.by_positions);
        for (std::size_t k = 0; k < result.handles[i].size(); ++k)
          result.handles[i][k] = of_handles[3 * result.held_nodes[k / 3] + k % 3];
        if (!slope.by_tension.empty())
        {
          result.tension[i] = slope.by_tension;
          for (double &value : result.tension[i])
            value = -value;
        }
        add(slope, sum);
        by_mass_damping += of_motion.by_mass_damping;
        by_stiffness_damping += of_motion.by_stiffness_damping;
        carry(of_motion, slope.by_start);
      }

      static bool
      all_zero(const std::vector<double> &numbers)
      {
        return std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0.; });
      }

      /// Derivatives of J by the state at the end of step i, whose velocities depend on its
      /// positions.
      Direction
      take_derivatives(const unsigned int i)
      {
        const StateDerivatives &own = by_states[i];
        Direction               by_state{ carried[0].positions,
                            std::vector<double>(problem.examples.poses.n_weights(), 0.) };
        by_velocities = carried[0].velocities;
        for (std::size_t dof = 0; dof < own.positions.size(); ++dof)
          by_state.positions[dof] += own.positions[dof];
        for (std::size_t dof = 0; dof < own.velocities.size(); ++dof)
          by_velocities[dof] += own.velocities[dof];
        std::copy(own.weights.begin(), own.weights.end(), by_state.weights.begin());
        if (is_dynamic)
          by_state.positions.add(problem.actions.integrator->rate_factor(), by_velocities);
        return by_state;
      }

      SlopeDerivatives
      derivatives(const State       &start,
                  const Direction   &direction,
                  MotionDerivatives &of_motion) const
      {
        SlopeDerivatives slope = derivatives_of_slope(problem, strains, direction);
        if (is_dynamic)
        {
          add_slope_of_inertia(problem, direction, slope, of_motion);
          add_slope_of_damping(problem, strains, start, direction, slope, of_motion);
        }
        return slope;
      }

      /// Carry the derivatives back to the states before this step. `by_start` is the slope's by what slips are counted from,
      /// through friction; empty: zero.
      void
      carry(const MotionDerivatives &of_motion, const Vector &by_start)
      {
        carried[0]      = std::move(carried[1]);
        carried[1]      = { zeros(), zeros() };
        const bool rubs = by_start.size() > 0;
        if (!is_dynamic)
        {
          if (rubs)
            carried[0].positions -= by_start;
          return;
        }
        const TimeIntegrator &integrator = *problem.actions.integrator;
        const State           places;
        const auto            history = integrator.history(places);
        for (std::size_t m = 0; m < history.size(); ++m)
        {
          const double c = history[m].weight;
          carried[m].positions.add(-c * integrator.rate_factor(), by_velocities);
          if (rubs)
            carried[m].positions.add(-c, by_start);
          if (of_motion.by_base.size() > 0)
          {
            carried[m].positions.add(-c, of_motion.by_base);
            carried[m].velocities.add(-c, of_motion.by_base_velocities);
          }
          if (!of_motion.by_past.empty())
            carried[m].positions -= of_motion.by_past[m];
        }
      }

      Problem                             &problem;
      const RecordedSteps                 &steps;
      const std::vector<StateDerivatives> &by_states;
      Visit                                visit;
      AdjointSystem                        system;
      const ExampleStrains                 strains;
      const bool                           is_dynamic;
      std::array<Carried, 2>               carried; ///< by the last states, the later one first
      Vector                               by_velocities; ///< at the end of a step
      SlopeDerivatives                     sum;
      double                               by_mass_damping = 0., by_stiffness_damping = 0.;
      TrajectoryGradients                  result;
    };
    /// Throws UserError for steps whose friction had not settled.
    void
    require_settled(const Problem &problem, const RecordedSteps &steps)
    {
      std::vector<unsigned int> unsettled;
      for (unsigned int i = 0; i < steps.size(); ++i)
        if (!steps.step(i).friction_settled)
          unsettled.push_back(i);
      if (!unsettled.empty())
        throw UserError(fmt::format(
            "vjp: friction had not settled in {} of {} steps, first in step {}, counted from 0, so "
            "that its forces are not those of the end of the step. {}",
            unsettled.size(), steps.size(), unsettled.front(), how_to_settle(problem)));
    }
  } // namespace

  RecordedSteps::RecordedSteps(const Problem &problem)
      : initial(problem.state),
        has_two_steps(problem.parameters.scene == SceneKind::dynamic
                      && problem.parameters.time.scheme == TimeScheme::bdf2),
        n_changes(problem.get_changes().n)
  {
    require_known_steps(problem);
  }

  void
  RecordedSteps::add(const Problem &problem, const State &start, const double size)
  {
    const unsigned int i        = steps.size();
    const bool         is_first = i == 0;
    const Vector      &v        = is_first ? initial.velocities : steps.back().velocities;
    const double       time     = is_first ? initial.time : steps.back().time;
    // BDF2 uses two states before a step, so that the earlier one must be unchanged, too
    const bool has_its_past = !has_two_steps || is_first
                              || (start.previous_step == steps.back().size
                                  && start.previous_positions == positions_before(i - 1));
    if (start.positions != positions_before(i) || start.velocities != v || start.time != time
        || !has_its_past)
      broken = "its state was set";
    if (problem.get_changes().n != n_changes)
      broken = "it was changed by " + problem.get_changes().last;
    const State &end = problem.state;
    steps.push_back({ end.time, size, end.positions, end.velocities, end.weights,
                      problem.actions.held_tensions, end.history, friction_has_settled(problem) });
  }

  void
  RecordedSteps::require_one_problem(const Problem &problem) const
  {
    if (!broken.empty())
      throw UserError(fmt::format("vjp: while the problem was recorded {}, and gradients are known "
                                  "for the steps of one problem alone. Record what comes after it.",
                                  broken));
    if (problem.get_changes().n != n_changes)
      throw UserError(fmt::format("vjp: since it was recorded the problem was changed by {}, so "
                                  "its steps would be others now. Record them anew.",
                                  problem.get_changes().last));
  }

  State
  RecordedSteps::start(const unsigned int i) const
  {
    if (i == 0)
      return initial;
    const RecordedStep &last  = steps[i - 1];
    State               state = initial;
    state.step                = initial.step + i;
    state.time                = last.time;
    state.positions           = last.positions;
    state.velocities          = last.velocities;
    state.weights             = last.weights;
    state.history             = last.history;
    if (has_two_steps)
    {
      state.previous_positions  = positions_before(i - 1);
      state.previous_velocities = i == 1 ? initial.velocities : steps[i - 2].velocities;
      state.previous_weights    = i == 1 ? initial.weights : steps[i - 2].weights;
      state.previous_step       = last.size;
    }
    return state;
  }

  TrajectoryGradients
  trajectory_gradients(Problem                             &problem,
                       const RecordedSteps                 &steps,
                       const std::vector<StateDerivatives> &by_states)
  {
    if (steps.size() == 0)
      throw UserError("vjp: no step was recorded. Call step() or run() in the with statement of "
                      "record().");
    steps.require_one_problem(problem);
    require_settled(problem, steps);
    return Backward(problem, steps, by_states).run();
  }
} // namespace Exemplar
