// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/problem/motion_review.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace Exemplar
{
  namespace
  {
    using Warning = std::optional<std::string>;

    // Ways relative to the body's size beyond which a motion is in another unit, and beyond which a
    // step does not follow it.
    constexpr double great_way = 20., great_step = 2.;

    // Way relative to the body's size below which there is no motion.
    constexpr double small_way = 1e-3;

    // Fraction of a step to look at: golden section, so that no oscillation aliases.
    constexpr double within = 0.381966;

    double
    greatest_difference(const Vector &a, const Vector &b)
    {
      MaxMagnitude maximum;
      for (unsigned int dof = 0; dof < a.size(); ++dof)
        maximum.add(a[dof] - b[dof]);
      return maximum.value();
    }

    /// The greatest displacements of held nodes, by component [m].
    struct Travel
    {
      double in_step = 0., in_all = 0.;
      double beside_step = 0.; ///< within a step, from linear interpolation
    };

    /// Travel of this process' nodes, sampled in a few of the steps.
    Travel
    look_at_travel(const Handles &handles, const TimeAxis &axis, const Vector &rest)
    {
      const unsigned int n_looks = std::min(axis.n_steps(), 8u);
      Travel             travel;
      Vector             before = rest, after = rest, middle = rest;
      for (unsigned int look = 1; look <= n_looks; ++look)
      {
        const auto step = static_cast<unsigned int>(std::size_t(look) * axis.n_steps() / n_looks);
        handles.move(axis.time(step - 1), before);
        handles.move(axis.time(step), after);
        travel.in_step = std::max(travel.in_step, greatest_difference(before, after));
        travel.in_all  = std::max(travel.in_all, greatest_difference(rest, after));
        handles.move((1. - within) * axis.time(step - 1) + within * axis.time(step), middle);
        before.sadd(1. - within, within, after);
        travel.beside_step = std::max(travel.beside_step, greatest_difference(before, middle));
      }
      return travel;
    }

    Warning
    review_travel(const Problem &problem, const Travel &travel)
    {
      const double      size    = problem.body.mesh.diameter();
      const std::string of_size = " times the size of the body (" + short_text(size) + " m)";
      if (travel.in_step > great_step * size)
        return "Handles move by up to " + short_text(travel.in_step) + " m in a step, "
               + short_text(travel.in_step / size) + of_size
               + ". Motions are in metres, angles in radians. If this is meant, take smaller "
                 "steps.";
      if (travel.in_all > great_way * size)
        return "Handles move by up to " + short_text(travel.in_all) + " m, "
               + short_text(travel.in_all / size) + of_size + ". Motions are in metres.";
      if (travel.beside_step > small_way * size && travel.beside_step > 4. * travel.in_all)
        return "Handles swing to and fro within a step: they are up to "
               + short_text(travel.beside_step)
               + " m beside the way from its beginning to its end, and a run sees these two alone. "
                 "Take smaller steps: twenty for each swing.";
      return {};
    }

    /// Start of a handle: its nodes' greatest distances [m], by component.
    struct Beginning
    {
      double from_rest;        ///< moved components: rest positions from the origin
      double from_double_rest; ///< positions at t = 0 from twice the rest positions
      double from_start;       ///< positions at t = 0 from the body's initial ones
    };

    Beginning
    look_at_beginning(const Problem &problem, const unsigned int handle, const Vector &moved)
    {
      const Vector               &rest = problem.body.fe_space.rest_positions();
      std::array<MaxMagnitude, 3> maximum;
      for (const unsigned int node : problem.constraints.handles.nodes(handle))
        for (unsigned int dof = 3 * node; dof < 3 * node + 3; ++dof)
        {
          if (moved[dof] != rest[dof]
              || problem.actions.mass != nullptr) // statics return to rest from any guess
            maximum[2].add(moved[dof] - problem.state.positions[dof]);
          if (moved[dof] == rest[dof] || moved[dof] == problem.state.positions[dof])
            continue; // not held, or not moved
          maximum[0].add(rest[dof]);
          maximum[1].add(moved[dof] - 2. * rest[dof]);
        }
      const Exchange &exchange = problem.body.exchange();
      return { exchange.max(maximum[0].value()), exchange.max(maximum[1].value()),
               exchange.max(maximum[2].value()) };
    }

    Warning
    review_beginning(const Problem &problem, const unsigned int handle, const Vector &moved)
    {
      const double      size = problem.body.mesh.diameter();
      const Beginning   at   = look_at_beginning(problem, handle, moved);
      const std::string key  = "Handles/" + problem.constraints.handles.name(handle);
      if (at.from_rest > small_way * size && at.from_double_rest < 1e-9 * at.from_rest)
        return key
               + ": at t = 0 its motion moves every node by the node's own place, as if it gave "
                 "places. It gives displacements from rest: take x; y; z off (in Python rest).";
      const bool follows_cache = !problem.parameters.handles[handle].follow_cache.empty();
      if (follows_cache || !(at.from_start > small_way * size) || problem.time_axis.n_steps() == 1)
        return {};
      return key + ": at t = 0 the held nodes are up to " + short_text(at.from_start)
             + " m from where the body starts, so they "
             + (problem.actions.mass != nullptr
                    ? "jump in the first step. Let its motion begin with 0, or let Initial/Pose "
                      "begin there."
                    : "go all of this way in the first increment. A motion gives displacements "
                      "from rest: let it begin with 0, such as t times what is there, or set "
                      "Initial/Pose.");
    }

    /// Travel of the handles in all processes; nothing if a motion is not finite, which the step
    /// reports.
    std::optional<Travel>
    travel_of(const Problem &problem)
    {
      Travel travel;
      if (problem.constraints.handles.size() == 0)
        return travel;
      const Exchange &exchange = problem.body.exchange();
      try
      {
        do_in_agreement(exchange,
                        [&]
                        {
                          travel = look_at_travel(problem.constraints.handles, problem.time_axis,
                                                  problem.body.fe_space.rest_positions());
                        });
      }
      catch (const SolverFailure &)
      {
        return {};
      }
      return Travel{ exchange.max(travel.in_step), exchange.max(travel.in_all),
                     exchange.max(travel.beside_step) };
    }

    void
    add_beginnings(const Problem &problem, std::vector<std::string> &warnings)
    {
      const Handles &handles = problem.constraints.handles;
      Vector         moved   = problem.state.positions; // free nodes stay there
      handles.move(problem.time_axis.time(0), moved);
      // handles of later grabs start where they are
      for (unsigned int handle = 0; handle < problem.parameters.handles.size(); ++handle)
        if (const Warning warning = review_beginning(problem, handle, moved))
          warnings.push_back(*warning);
    }

    std::vector<std::string>
    warnings_of_handles(const Problem &problem, const Travel &travel, const bool begins)
    {
      std::vector<std::string> warnings;
      if (begins)
        add_beginnings(problem, warnings);
      if (const Warning warning = review_travel(problem, travel))
        warnings.push_back(*warning);
      return warnings;
    }
  } // namespace

  std::vector<std::string>
  motion_warnings(const Problem &problem, const bool is_resumed)
  {
    const std::optional<Travel> travel = travel_of(problem);
    if (problem.constraints.handles.size() == 0 || !travel)
      return {};
    return warnings_of_handles(problem, *travel, !is_resumed);
  }

  std::vector<std::string>
  next_step_warnings(const Problem &problem)
  {
    const Handles &handles = problem.constraints.handles;
    if (handles.size() == 0)
      return {};
    const Vector &before = problem.state.positions;
    Vector        after  = before;
    handles.move(next_step(problem).end, after);
    Travel travel;
    travel.in_step = problem.body.exchange().max(greatest_difference(before, after));
    return warnings_of_handles(problem, travel, problem.state.step == 0);
  }

  bool
  is_any_handle_moved(const Problem &problem)
  {
    const std::optional<Travel> travel = travel_of(problem);
    return !travel || travel->in_all > 0.;
  }
} // namespace Exemplar
