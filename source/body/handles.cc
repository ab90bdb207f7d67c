// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/plain_name.h>
#include <exemplar/body/handle_overlaps.h>
#include <exemplar/body/handles.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

namespace Exemplar
{
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
      handles.push_back(make_handle(p, mesh, fe_space, poses, nodes));
      if (const auto given = motions.find(p.name); given != motions.end())
        handles.back().function = at_middles_too(given->second, handles.back().nodes, fe_space);
    }
    dealii::Vector<double> anywhere(fe_space.n_dofs());
    move(axis.time(0), anywhere); // are the formulas finite?
    move(axis.time(axis.n_steps()), anywhere);
    check_overlaps(axis);
    warnings = review_of_motions(handles, fe_space, axis);
    for (const Handle &handle : handles)
      if (std::string idle = describe_idle_time(handle, axis, rounding); !idle.empty())
        warnings.push_back(std::move(idle));
  }

  Handles::Displacements
  Handles::displacements(const double time) const
  {
    Displacements all;
    do_in_agreement(fe_space.exchange(), // a motion may fail on one process alone
                    [&]
                    {
                      for (const Handle &handle : handles)
                      {
                        all.push_back(handle.displacements(rest_positions(handle, fe_space), time));
                        for (std::size_t point = 0; point < handle.offsets.size(); ++point)
                          all.back()[point] += handle.offsets[point];
                      }
                    });
    return all;
  }

  Handle &
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
      all.push_back({ handle.holds, handle.nodes, handle.components, handle.function,
                      handle.following_tips });
    return all;
  }

  void
  Handles::restore(const std::vector<Holding> &holding)
  {
    while (handles.size() > holding.size())
      handles.pop_back();
    for (std::size_t h = 0; h < handles.size(); ++h)
    {
      handles[h].holds          = holding[h].holds;
      handles[h].nodes          = holding[h].nodes;
      handles[h].components     = holding[h].components;
      handles[h].following_tips = holding[h].following_tips;
      handles[h].function       = holding[h].function;
    }
  }

  void
  Handles::set_motion(const std::string &name, Motion motion)
  {
    find(name).function = std::move(motion);
  }

  void
  Handles::grab(const std::string               &name,
                const std::vector<unsigned int> &nodes,
                Motion                           motion,
                const Edges                      edges)
  {
    const auto named = std::find_if(handles.begin(), handles.end(),
                                    [&](const Handle &handle) { return handle.name == name; });
    if (named != handles.end())
      find_untimed(name);
    if (named != handles.end() && named->holds)
      throw UserError("There is a handle '" + name
                      + "' already. Give another name, or let that one go first.");
    require_plain_name(name, "Handle");
    if (!motion)
      throw UserError("Handle '" + name + "' has no motion. Give a function of place and time.");
    const std::string               key  = "Handles/" + name;
    const bool                      adds = edges == Edges::between_vertices || !fe_space.is_shell();
    const std::vector<unsigned int> all  = adds ? fe_space.numbering().with_middles(nodes) : nodes;
    const std::vector<unsigned int> xyz  = { 0, 1, 2 };
    Motion                          moving = at_middles_too(motion, all, fe_space);
    if (named != handles.end())
    {
      named->nodes      = all;
      named->components = xyz;
      named->function   = std::move(moving);
      named->holds      = true;
      named->following_tips.clear();
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

  std::vector<unsigned int>
  Handles::held_dofs() const
  {
    std::set<unsigned int> dofs;
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.held_nodes())
        for (const unsigned int c : handle.components_of(node))
          dofs.insert(3 * node + c);
    return { dofs.begin(), dofs.end() };
  }

  HeldTips
  Handles::held_tips() const
  {
    const unsigned int first = fe_space.numbering().n_places();
    HeldTips           tips(fe_space.n_nodes() - first, 0);
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.held_nodes())
        if (node >= first)
          tips[node - first] |= handle.held_components();
    return tips;
  }

  void
  Handles::set_positions(const Handle                            &handle,
                         const std::vector<dealii::Tensor<1, 3>> &displacements,
                         const HeldTips                          &tips,
                         dealii::Vector<double>                  &positions) const
  {
    const unsigned int first = fe_space.numbering().n_places();
    for (unsigned int point = 0; point < handle.held_nodes().size(); ++point)
    {
      const unsigned int node  = handle.nodes[point];
      const unsigned int other = node < first ? 0 : tips[node - first] & ~handle.held_components();
      for (const unsigned int c : handle.components_of(node))
        if ((other >> c & 1U) == 0)
          positions[3 * node + c]
              = fe_space.rest_positions()[3 * node + c] + displacements[point][c];
    }
  }

  void
  Handles::move_by_formulas(const double time, dealii::Vector<double> &positions) const
  {
    for (const Handle &handle : handles)
      for (unsigned int point = 0; point < handle.held_nodes().size(); ++point)
      {
        const unsigned int   node  = handle.nodes[point];
        const auto           rest  = fe_space.rest_position(node);
        dealii::Tensor<1, 3> moved = handle.displacement(point, rest, time);
        if (!handle.offsets.empty())
          moved += handle.offsets[point];
        for (const unsigned int c : handle.components_of(node))
          positions[3 * node + c] = rest[c] + moved[c];
      }
  }

  void
  Handles::move(const double time, dealii::Vector<double> &positions) const
  {
    if (std::none_of(handles.begin(), handles.end(),
                     [](const Handle &h) { return h.function || !h.following_tips.empty(); }))
    {
      const auto action = [&] { move_by_formulas(time, positions); };
      do_in_agreement(fe_space.exchange(), std::cref(action)); // one process alone may fail
      return;
    }
    const Displacements all  = displacements(time);
    const HeldTips      tips = held_tips();
    for (unsigned int h = 0; h < handles.size(); ++h)
      set_positions(handles[h], all[h], tips, positions);
    // motions by functions could not be checked at all times before
    check_agreement(handles, shared_nodes(handles), all, time, mesh, fe_space);
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

  // Handles with a From or Until, which release and catch nodes between steps. Which handles hold is
  // a function of the time at which a step begins, and the offsets of caught nodes are one of the
  // positions there, so that no history is needed.

  std::string
  describe_idle_time(const Handle &handle, const TimeAxis &axis, const double rounding)
  {
    for (unsigned int step = 0; step < axis.n_steps(); ++step)
      if (handle.time.holds(axis.time(step), rounding))
        return {};
    const std::string when = std::isfinite(handle.time.until)
                                 ? " between From = " + shortest_text(handle.time.from)
                                       + " and Until = " + shortest_text(handle.time.until)
                                 : " at From = " + shortest_text(handle.time.from) + " or later";
    return "Handles/" + handle.name + " holds in no step: none begins" + when
           + ". Times of this scene go from 0 to " + shortest_text(axis.time(axis.n_steps())) + ".";
  }

  bool
  Handles::have_times() const
  {
    return std::any_of(handles.begin(), handles.end(),
                       [](const Handle &handle) { return !handle.time.is_always(); });
  }

  bool
  Handles::follow_time(const double time)
  {
    bool has_changed = false;
    for (Handle &handle : handles)
    {
      if (handle.time.is_always())
        continue;
      const bool holds = handle.time.holds(time, rounding);
      has_changed      = has_changed || holds != handle.holds;
      handle.holds     = holds;
      if (!handle.time.has_caught(time, rounding))
        handle.offsets.clear();
    }
    return has_changed;
  }

  void
  Handles::begin_step(const double time, const dealii::Vector<double> &positions)
  {
    for (Handle &handle : handles)
      if (handle.holds && handle.time.has_caught(time, rounding))
      {
        const auto rest = rest_positions(handle, fe_space);
        const auto way  = handle.displacements(rest, time);
        handle.offsets.resize(rest.size());
        for (std::size_t point = 0; point < rest.size(); ++point)
          for (unsigned int c = 0; c < 3; ++c)
            handle.offsets[point][c]
                = positions[3 * handle.nodes[point] + c] - rest[point][c] - way[point][c];
      }
  }

  Handle &
  Handles::find_untimed(const std::string &name)
  {
    Handle &handle = find(name);
    if (!handle.time.is_always())
      throw UserError("Handles/" + name
                      + " holds as its From and Until say. Remove them to hold it and let it go "
                        "by calls.");
    return handle;
  }

  void
  Handles::check_overlaps(const TimeAxis &axis)
  {
    // shared nodes may lie in one process, but the checks and displacements() are collective
    std::set<unsigned int> shared;
    bool                   any_shares  = false;
    const auto             find_shared = [&]
    {
      shared     = shared_nodes(handles);
      any_shares = fe_space.exchange().any(!shared.empty());
    };
    follow_time(axis.time(0));
    find_shared();
    for (unsigned int step = 0; step <= axis.n_steps() && (any_shares || have_times()); ++step)
    {
      const double begin = axis.time(std::max(step, 1U) - 1);
      if (follow_time(begin) || step == 0)
      {
        find_shared();
        if (have_times())
          refuse_shared_catches(handles, begin, rounding, mesh, fe_space);
      }
      if (any_shares)
        check_agreement(handles, shared, displacements(axis.time(step)), axis.time(step), mesh,
                        fe_space);
    }
    follow_time(axis.time(0));
  }
} // namespace Exemplar
