// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/python/saved_state.h>

#include <boost/archive/archive_exception.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace Exemplar::Python
{
  namespace
  {
    /// A hash of numbers: it changes if one of them does.
    class Digest
    {
    public:
      void
      add(const double number)
      {
        std::uint64_t bits;
        std::memcpy(&bits, &number, sizeof(bits));
        value = (value ^ bits) * 0x9e3779b97f4a7c15u;
        value ^= value >> 29;
      }

      template <typename Numbers>
      void
      add_all(const Numbers &numbers)
      {
        add(static_cast<double>(numbers.size()));
        for (const auto &number : numbers)
          add(static_cast<double>(number));
      }

      std::uint64_t value = 1;
    };

    /// Add what handles hold, those with a From or Until whether they hold it now or not.
    void
    add_handles(const Problem &problem, Digest &digest)
    {
      const auto &of_scene = problem.parameters.handles;
      std::size_t number   = 0; // those of the scene come first
      for (const Handles::Holding &of : problem.constraints.handles.holding())
      {
        const bool is_timed
            = number < of_scene.size() && !of_scene[number].holding_time().is_always();
        digest.add(is_timed || of.holds ? 1. : 0.);
        digest.add_all(of.nodes);
        digest.add_all(of.components);
        ++number;
      }
    }

    /// Digest of the settings, beside the state, that a solver's memory depends on.
    std::uint64_t
    settings_of(const Problem &problem)
    {
      const SceneParameters &parameters = problem.parameters;
      Digest                 digest;
      digest.add(static_cast<double>(parameters.scene));
      digest.add(static_cast<double>(parameters.solver.method));
      digest.add(static_cast<double>(parameters.time.scheme));
      digest.add(parameters.time.mass_damping);
      digest.add(parameters.time.stiffness_damping);
      digest.add(problem.examples.poses.size() == 0 ? 0. : parameters.examples.importance);
      digest.add(problem.examples.poses.size() == 0 ? 0.
                                                    : blended_part(parameters.examples.energy));
      digest.add_all(parameters.loads.gravity);
      digest.add(static_cast<double>(problem.actions.own_terms.size()));
      add_handles(problem, digest);
      digest.add_all(problem.body.fe_space.rest_positions());
      for (unsigned int i = 0; i < problem.examples.poses.size(); ++i)
        digest.add_all(problem.examples.poses.pose(i));
      digest.add_all(problem.actions.held_tensions);
      if (problem.actions.loads != nullptr)
        digest.add_all(problem.actions.loads->nodal_forces());
      for (unsigned int cell = 0; cell < problem.body.mesh.n_cells(); ++cell)
      {
        digest.add(problem.body.material.elasticity(cell).lambda);
        digest.add(problem.body.material.elasticity(cell).mu);
        digest.add(problem.body.material.density(cell));
      }
      return digest.value;
    }

    void
    check_size(const std::string &what, const std::size_t given, const std::size_t here)
    {
      if (given != here)
        throw UserError(fmt::format(
            "The state is of another body: it has {} {}, this problem {}. Take a state of this "
            "problem, or of one of the same scene.",
            given, what, here));
    }

    void
    check_dynamics(const State &state, const Problem &problem)
    {
      const bool is_dynamic = problem.parameters.scene == SceneKind::dynamic;
      if (state.velocities.size() > 0 && !is_dynamic)
        throw UserError("The state has velocities, but this problem is not dynamic.");
      if (state.velocities.size() == 0 && is_dynamic)
        throw UserError("The state has no velocities, as it is of a problem that is not dynamic, "
                        "but this one is. Take a state of a dynamic problem.");
      if (const double size = problem.time_axis.step_size(1);
          is_dynamic && std::isfinite(state.time) && !(state.time + size > state.time))
        throw UserError(fmt::format("The state is at t = {} s, beside which a step of {} s is "
                                    "nothing. Set another time: state.replace(time=...).",
                                    shortest_text(state.time), shortest_text(size)));
      if (!is_dynamic && !(state.time >= 0. && state.time <= 1.))
        throw UserError("The state is at t = " + shortest_text(state.time)
                        + ", but in a scene that is not dynamic t goes from 0 to 1.");
    }

    void
    check_weights(const std::vector<double> &weights, const Problem &problem)
    {
      const ExampleWeights &rule = problem.examples.weights;
      check_size("weights", weights.size(), rule.size());
      if (rule.n_unknown() == 0)
        return; // prescribed weights are taken instead
      const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
      if (rule.are_additive() && (*least < 0. || *most > 1.))
        throw UserError("The state has a weight of " + shortest_text(*least < 0. ? *least : *most)
                        + ", but with Examples/Weights = additive all are between 0 and 1.");
      if (rule.are_bounded() && *least < 0.)
        throw UserError("The state has a weight of " + shortest_text(*least)
                        + ", but with Examples/Weights = simplex none is below 0.");
      if (rule.are_additive())
        return;
      for (auto first = weights.begin(); first != weights.end(); first += rule.n_per_region())
        if (const double sum = std::accumulate(first, first + rule.n_per_region(), 0.);
            !(std::abs(sum - 1.) < 1e-8))
          throw UserError("The state has weights that sum to " + shortest_text(sum)
                          + ", not to 1.");
    }

    template <typename Numbers>
    void
    check_finite(const std::string &what, const Numbers &numbers)
    {
      for (const double number : numbers)
        if (!std::isfinite(number))
          throw UserError("The state has " + what + " that are not finite numbers.");
    }
  } // namespace

  SavedState
  save_state(const Problem &problem, const Work &work)
  {
    return { problem.state, work, problem.solver_memory(), settings_of(problem) };
  }

  void
  check_fits(const SavedState &saved, const Problem &problem)
  {
    const State &state = saved.state;
    check_size("nodes", state.positions.size() / 3, problem.body.fe_space.n_nodes());
    check_dynamics(state, problem);
    check_weights(state.weights, problem);
    if (state.history.size() != problem.state.history.size())
      throw UserError(fmt::format(
          "The state is of other laws: they remember {} numbers, those of this problem {}. Take a "
          "state of this problem, or of one of the same Model and Material.",
          state.history.size(), problem.state.history.size()));
    check_finite("positions", state.positions);
    check_finite("velocities", state.velocities);
    check_finite("weights", state.weights);
    check_finite("times", std::vector<double>{ state.time });
  }

  void
  restore_state(const SavedState &saved, Problem &problem)
  {
    const bool is_of_use = saved.settings == settings_of(problem);
    try
    {
      problem.resume_from(saved.state, is_of_use ? saved.memory : "");
    }
    catch (const boost::archive::archive_exception &)
    {
      problem.resume_from(saved.state); // without memory steps converge, too
    }
  }
} // namespace Exemplar::Python
