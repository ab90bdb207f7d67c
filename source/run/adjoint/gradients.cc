// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/adjoint/adjoint_checks.h>
#include <exemplar/run/adjoint/adjoint_solve.h>
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/gradients.h>
#include <exemplar/run/adjoint/slope_of_contact.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Threshold for weakly active: of a weight at its bound, the relative multiplier; else its
    /// distance to the bound.
    constexpr double weak = 1e-6;

    /// Whether a weight is weakly active; `slope` is the potential's, multiplier included.
    bool
    is_weak(const ExampleWeights &rule,
            const unsigned int    weight,
            const double          w,
            const double          slope,
            const double          scale)
    {
      const WeightMemory &memory = rule.get_memory();
      const auto [up, down]      = memory.slopes(weight, w, slope);
      if (!rule.is_off_bounds(w))
        return (w > 0. ? -down : up) < weak * scale;
      if (up > down) // memory keeps the weight in place
        return std::min(up, -down) < weak * scale;
      return (rule.are_bounded() && w < weak) || (rule.are_additive() && w > 1. - weak)
             || memory.slopes(weight, w + weak, 0.).up != memory.slopes(weight, w - weak, 0.).up;
    }

    template <typename Numbers>
    Numbers
    negative(Numbers numbers)
    {
      for (auto &number : numbers)
        number = -number;
      return numbers;
    }
  } // namespace

  namespace
  {
    std::vector<ObstacleGradients>
    of_obstacles(const Problem &problem, const SlopeDerivatives &slope)
    {
      std::vector<ObstacleGradients> result;
      for (std::size_t i = 0; i < slope.of_obstacles.size(); ++i)
      {
        const Obstacle   &obstacle = problem.actions.obstacles->all[i];
        const auto       &found    = slope.of_obstacles[i];
        ObstacleGradients one{ obstacle.name(), {}, {}, {} };
        if (!obstacle.was_set_back())
        {
          one.displacement = -found.by_place;
          if (obstacle.shape().radius > 0.)
            one.radius = -found.by_radius;
        }
        if (obstacle.friction() > 0.)
          one.friction = -found.by_coefficient;
        result.push_back(std::move(one));
      }
      return result;
    }
  } // namespace

  namespace
  {
    /// Tips that follow their edges are prescribed by a handle relative to the displacements that it has for the middles of these.
    void
    add_middles_of_tips(const Problem &problem, Vector &of_held)
    {
      const NodeNumbering &nodes = problem.body.fe_space.numbering();
      const HeldTips      &tips  = problem.constraints.held_tips;
      for (unsigned int edge = 0; edge < tips.size(); ++edge)
        for (unsigned int c = 0; c < 3 && follows_edge(tips[edge]); ++c)
          if ((tips[edge] >> c & 1) == 0)
            for (const unsigned int end : nodes.ends(nodes.n_places() + edge))
              of_held[3 * end + c] -= 0.5 * of_held[3 * (nodes.n_places() + edge) + c];
    }
  } // namespace

  std::vector<unsigned int>
  weakly_active(const Problem &problem, const Evaluation &evaluation)
  {
    const ExampleWeights      &rule   = problem.examples.weights;
    const std::vector<double> &w      = problem.state.weights,
                              &slopes = evaluation.elastic.weight_gradient;
    std::vector<unsigned int> found;
    if (rule.n_unknown() == 0)
      return found;
    const std::vector<double> multipliers = rule.residual(w, slopes).multipliers;
    for (unsigned int weight = 0; weight < w.size(); ++weight)
      if (is_weak(rule, weight, w[weight],
                  slopes[weight]
                      + (rule.are_additive() ? 0. : multipliers[weight / rule.n_per_region()]),
                  evaluation.elastic.weight_scale))
        found.push_back(weight);
    return found;
  }

  Vector
  of_held(const Problem &problem, Vector difference, const Vector &by_positions)
  {
    difference -= by_positions;
    for (const unsigned int dof : problem.potential.get_free_dofs().list())
      difference[dof] = 0.;
    add_middles_of_tips(problem, difference);
    return difference;
  }

  Gradients
  gradients_of(const Problem &problem, SlopeDerivatives slope)
  {
    carry_to_parameters(problem, slope);
    Gradients result;
    if (!has_orthotropic_cells(problem))
    {
      result.young   = negative(std::move(slope.by_young));
      result.poisson = negative(std::move(slope.by_poisson));
    }
    result.density = negative(std::move(slope.by_density));
    if (!slope.by_thickness.empty())
      result.thickness = negative(std::move(slope.by_thickness));
    if (!slope.by_tension.empty())
      result.tension = negative(std::move(slope.by_tension));
    result.nodal_forces       = negative(std::move(slope.by_nodal_forces));
    result.gravity            = negative(slope.by_gravity);
    const ExamplePoses &poses = problem.examples.poses;
    if (poses.size() > 0)
      result.importance = -slope.by_importance;
    for (unsigned int i = 0; i < poses.size(); ++i)
      if (poses.is_strained(i))
        result.poses.push_back(negative(std::move(slope.by_poses[i])));
    const ExampleParameters &examples = problem.parameters.examples;
    if ((!examples.weights_per_region || examples.region_blend_length == 0.)
        && examples.regions == RegionsOfExamples::none && !problem.body.mesh.is_shell()
        && knows_starts_in_contact(problem))
      result.rest_positions = negative(std::move(slope.by_rest_positions));
    result.obstacles = of_obstacles(problem, slope);
    return result;
  }

  void
  require_finite(const Gradients &found, const double sum_of_others)
  {
    const auto is_finite = [](const auto &numbers)
    {
      return std::all_of(numbers.begin(), numbers.end(),
                         [](const double x) { return std::isfinite(x); });
    };
    bool all = std::isfinite(sum_of_others) && is_finite(found.density) && is_finite(found.handles)
               && is_finite(found.nodal_forces) && is_finite(found.gravity)
               && std::isfinite(found.importance.value_or(0.));
    for (const auto *numbers : { &found.young, &found.poisson, &found.thickness, &found.tension })
      all = all && (!*numbers || is_finite(**numbers));
    for (const Vector &pose : found.poses)
      all = all && is_finite(pose);
    for (const ObstacleGradients &obstacle : found.obstacles)
      all = all && std::isfinite(obstacle.displacement.value_or(SpaceVector3()).norm())
            && std::isfinite(obstacle.radius.value_or(0.))
            && std::isfinite(obstacle.friction.value_or(0.));
    if (!all || (found.rest_positions && !is_finite(*found.rest_positions)))
      throw SolverFailure(too_large);
  }

  Gradients
  gradients(Problem &problem, const Direction &by_state)
  {
    require_known_scene(problem);
    require_rotations(problem);
    Evaluation evaluation;
    problem.potential.evaluate(problem.state, RotationUse::update, evaluation);
    require_equilibrium(problem, evaluation);
    SlopeDerivatives slope   = solve_adjoint(problem, evaluation, by_state).derivatives;
    Vector           handles = of_held(problem, by_state.positions, slope.by_positions);
    Gradients        result  = gradients_of(problem, std::move(slope));
    result.handles           = std::move(handles);
    require_finite(result);
    result.weakly_active = weakly_active(problem, evaluation);
    return result;
  }
} // namespace Exemplar
