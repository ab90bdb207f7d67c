// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/handles.h>
#include <exemplar/prm/assignments.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace Exemplar
{
  namespace
  {
    std::vector<unsigned int>
    parse_components(const std::string &text, const std::string &key)
    {
      std::set<unsigned int> components;
      for (const std::string &word : split_trimmed(text, ','))
        if (word == "x" || word == "y" || word == "z")
          components.insert(static_cast<unsigned int>(word[0] - 'x'));
        else
          components.insert(3);
      std::string meant;
      for (const std::string c : { "x", "y", "z" })
        if (text.find(c) != std::string::npos)
          meant += (meant.empty() ? "" : ", ") + c;
      if (components.empty() || components.count(3) == 1)
        throw UserError(key + "/Components = '" + text
                        + "' is not allowed. Allowed: some of x, y, z, separated by commas, such "
                          "as '"
                        + (meant.empty() ? "x, y" : meant) + "'.");
      return { components.begin(), components.end() };
    }

    std::vector<dealii::Point<3>>
    choose(const std::vector<dealii::Point<3>> &all, const std::vector<unsigned int> &nodes)
    {
      std::vector<dealii::Point<3>> chosen;
      for (const unsigned int node : nodes)
        chosen.push_back(all[node]);
      return chosen;
    }

    /// Of a handle that overlaps with others.
    std::string
    remedy_of_all(const std::string &handle)
    {
      return ". Handles/" + handle + "/Select selects all nodes of the body: make it smaller.";
    }

    /// The displacements that a program's function has given for `n_points`.
    std::vector<dealii::Tensor<1, 3>>
    checked(std::vector<dealii::Tensor<1, 3>> displacements,
            const std::size_t                 n_points,
            const std::string                &key,
            const double                      time)
    {
      if (displacements.size() != n_points)
        throw UserError(fmt::format(
            "{}: the function of its motion gives {} displacements, but it holds {} nodes.", key,
            displacements.size(), n_points));
      for (const dealii::Tensor<1, 3> &displacement : displacements)
        if (!std::isfinite(displacement.norm_square()))
          throw SolverFailure(key + ": the function of its motion gives what is not finite at t = "
                              + shortest_text(time) + ".");
      return displacements;
    }
  } // namespace

  Handles::Handles(const std::vector<HandleParameters> &parameters,
                   const Mesh                          &mesh,
                   const FESpace                       &fe_space,
                   const TimeAxis                      &axis,
                   const NamedPoses                    &poses,
                   const NamedNodes                    &nodes,
                   const NamedMotions                  &motions)
      : mesh(mesh), fe_space(fe_space), rounding(1e-9 * axis.step_size(1))
  {
    for (const HandleParameters &p : parameters)
    {
      handles.push_back(make_handle(p, poses, nodes));
      if (const auto given = motions.find(p.name); given != motions.end())
        handles.back().function = at_middles_too(given->second, handles.back().nodes, fe_space);
    }
    dealii::Vector<double> anywhere(fe_space.n_dofs());
    move(axis.time(0), anywhere); // are the formulas finite?
    move(axis.time(axis.n_steps()), anywhere);
    check_overlaps(axis);
    look_for_straight_turns(axis);
    look_for_large_turns(axis);
    look_for_progress_beyond(axis);
    look_for_idle_times(axis);
  }

  Handles::Handle
  Handles::make_handle(const HandleParameters &p,
                       const NamedPoses       &poses,
                       const NamedNodes       &named_nodes) const
  {
    p.check();
    const std::string key = "Handles/" + p.name;
    Handle            handle{ p.name,
                   fe_space.numbering().with_middles(p.select.nodes(mesh, key, named_nodes)),
                   parse_components(p.components, key),
                   Expression(key + "/Motion", p.motion, "xyzt", 3),
                   Expression(key + "/Progress", p.progress, "t", 1),
                   {},
                   {},
                   p.holding_time() };
    if (!p.follow_pose.empty())
    {
      const auto pose = fe_space.numbering().complete(
          mesh.find_pose(poses, p.follow_pose, key + "/Follow pose"), key + "/Follow pose");
      handle.path.emplace(whole_handle(handle.nodes, rest_positions(handle), fe_space),
                          whole_handle(handle.nodes, choose(pose, handle.nodes), fe_space));
      handle.places_in_path = places_in_whole(handle.nodes, fe_space);
    }
    return handle;
  }

  std::vector<dealii::Point<3>>
  Handles::rest_positions(const Handle &handle) const
  {
    std::vector<dealii::Point<3>> places;
    for (const unsigned int node : handle.nodes)
      places.push_back(fe_space.rest_position(node));
    return places;
  }

  std::vector<dealii::Tensor<1, 3>>
  Handles::Handle::displacements(const std::vector<dealii::Point<3>> &rest, const double time) const
  {
    if (function)
      return checked(function(rest, time), rest.size(), "Handles/" + name, time);
    std::vector<dealii::Tensor<1, 3>> result;
    for (unsigned int point = 0; point < nodes.size(); ++point)
      result.push_back(
          path ? path->displacement(places_in_path[point], progress.values(rest[point], time)[0])
               : motion.vector(rest[point], time));
    return result;
  }

  Handles::Displacements
  Handles::displacements(const double time) const
  {
    Displacements all;
    std::string   failure; // a process may have no node of a handle that fails
    try
    {
      for (const Handle &handle : handles)
      {
        all.push_back(handle.displacements(rest_positions(handle), time));
        for (std::size_t point = 0; point < handle.offsets.size(); ++point)
          all.back()[point] += handle.offsets[point];
      }
    }
    catch (const SolverFailure &error)
    {
      failure = error.what();
    }
    failure = fe_space.exchange().first_text(std::move(failure));
    if (!failure.empty())
      throw SolverFailure(failure);
    return all;
  }

  Handles::Handle &
  Handles::find(const std::string &name)
  {
    std::string names;
    for (Handle &handle : handles)
    {
      if (handle.name == name)
        return handle;
      names += (names.empty() ? "" : ", ") + handle.name;
    }
    throw UserError(
        "There is no handle '" + name + "'. "
        + (names.empty() ? "Add it to Handles/Names." : "Handles/Names has: " + names + "."));
  }

  std::vector<Handles::Holding>
  Handles::holding() const
  {
    std::vector<Holding> all;
    for (const Handle &handle : handles)
      all.push_back({ handle.holds, handle.nodes, handle.components, handle.function });
    return all;
  }

  void
  Handles::restore(const std::vector<Holding> &holding)
  {
    while (handles.size() > holding.size())
      handles.pop_back();
    for (std::size_t h = 0; h < handles.size(); ++h)
    {
      handles[h].holds      = holding[h].holds;
      handles[h].nodes      = holding[h].nodes;
      handles[h].components = holding[h].components;
      handles[h].function   = holding[h].function;
    }
  }

  void
  Handles::set_motion(const std::string &name, Motion motion)
  {
    find(name).function = std::move(motion);
  }

  void
  Handles::grab(const std::string &name, const std::vector<unsigned int> &nodes, Motion motion)
  {
    const auto named = std::find_if(handles.begin(), handles.end(),
                                    [&](const Handle &handle) { return handle.name == name; });
    if (named != handles.end())
      find_untimed(name);
    if (named != handles.end() && named->holds)
      throw UserError("There is a handle '" + name
                      + "' already. Give another name, or let that one go first.");
    if (!motion)
      throw UserError("Handle '" + name + "' has no motion. Give a function of place and time.");
    const std::string               key    = "Handles/" + name;
    const std::vector<unsigned int> all    = fe_space.numbering().with_middles(nodes);
    const std::vector<unsigned int> xyz    = { 0, 1, 2 };
    Motion                          moving = at_middles_too(motion, all, fe_space);
    if (named != handles.end())
    {
      named->nodes      = all;
      named->components = xyz;
      named->function   = std::move(moving);
      named->holds      = true;
      return;
    }
    handles.push_back({ name,
                        all,
                        xyz,
                        Expression(key + "/Motion", "0; 0; 0", "xyzt", 3),
                        Expression(key + "/Progress", "t", "t", 1),
                        {},
                        std::move(moving) });
  }

  void
  Handles::check_agreement(const std::set<unsigned int> &shared,
                           const Displacements          &displacements,
                           const double                  time) const
  {
    const double tolerance = 1e-10 * mesh.diameter();
    struct Target
    {
      double       displacement;
      unsigned int handle;
    };
    std::map<unsigned int, Target> targets;
    for (unsigned int h = 0; h < handles.size(); ++h)
      for (unsigned int point = 0; point < handles[h].held_nodes().size(); ++point)
      {
        const unsigned int node = handles[h].nodes[point];
        if (shared.count(node) == 0)
          continue;
        const dealii::Tensor<1, 3> &displacement = displacements[h][point];
        for (const unsigned int c : handles[h].components)
        {
          const auto [first, is_new] = targets.emplace(3 * node + c, Target{ displacement[c], h });
          if (std::abs(first->second.displacement - displacement[c]) > tolerance)
            throw UserError("Handles '" + handles[first->second.handle].name + "' and '"
                            + handles[h].name + "' both hold " + name_of_node(node, mesh, fe_space)
                            + ", but move it differently at t = " + shortest_text(time)
                            + (handles[first->second.handle].nodes.size() == fe_space.n_nodes()
                                   ? remedy_of_all(handles[first->second.handle].name)
                               : handles[h].nodes.size() == fe_space.n_nodes()
                                   ? remedy_of_all(handles[h].name)
                                   : ". Change Handles/" + handles[h].name
                                         + "/Select so that they do not overlap."));
        }
      }
  }

  std::vector<unsigned int>
  Handles::held_dofs() const
  {
    std::set<unsigned int> dofs;
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.held_nodes())
        for (const unsigned int c : handle.components)
          dofs.insert(3 * node + c);
    return { dofs.begin(), dofs.end() };
  }

  void
  Handles::move(const double time, dealii::Vector<double> &positions) const
  {
    const Displacements all = displacements(time);
    for (unsigned int h = 0; h < handles.size(); ++h)
      for (unsigned int point = 0; point < handles[h].held_nodes().size(); ++point)
      {
        const unsigned int node = handles[h].nodes[point];
        for (const unsigned int c : handles[h].components)
          positions[3 * node + c] = fe_space.rest_positions()[3 * node + c] + all[h][point][c];
      }
    // what is no formula could not be checked at all times before
    if (std::any_of(handles.begin(), handles.end(), [](const Handle &h) { return h.function; }))
      check_agreement(shared_nodes(), all, time);
  }

  bool
  Handles::are_elsewhere(const double time, const dealii::Vector<double> &positions) const
  {
    dealii::Vector<double> moved = positions;
    move(time, moved);
    return fe_space.exchange().any(moved != positions);
  }

  unsigned int
  Handles::n_nodes(const unsigned int handle) const
  {
    const Exchange &exchange = fe_space.exchange();
    const auto     &nodes    = handles[handle].nodes;
    const auto      n_owned  = std::count_if(
              nodes.begin(), nodes.end(), [&](const unsigned int node) { return exchange.owns(node); });
    return static_cast<unsigned int>(exchange.sum(static_cast<double>(n_owned)));
  }

  dealii::Tensor<1, 3>
  Handles::sum_over(const unsigned int handle, const dealii::Vector<double> &field) const
  {
    dealii::Tensor<1, 3> sum;
    const Exchange      &exchange = fe_space.exchange();
    for (const unsigned int node : handles[handle].held_nodes())
      for (const unsigned int c : handles[handle].components)
        if (exchange.owns(node))
          sum[c] += field[3 * node + c];
    exchange.sum(sum.begin_raw(), 3);
    return sum;
  }
} // namespace Exemplar
