// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/handles.h>

#include <algorithm>
#include <map>
#include <set>

// Handles with a time: they let go and catch between steps. Which hold is a function of the time at which a
// step begins, and where caught nodes are of the positions there, so that nothing has to be remembered.

namespace Exemplar
{
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
        const auto rest = rest_positions(handle);
        const auto way  = handle.displacements(rest, time);
        handle.offsets.resize(rest.size());
        for (std::size_t point = 0; point < rest.size(); ++point)
          for (unsigned int c = 0; c < 3; ++c)
            handle.offsets[point][c]
                = positions[3 * handle.nodes[point] + c] - rest[point][c] - way[point][c];
      }
  }

  Handles::Handle &
  Handles::find_untimed(const std::string &name)
  {
    Handle &handle = find(name);
    if (!handle.time.is_always())
      throw UserError("Handles/" + name
                      + " holds as its From and Until say. Remove them to hold it and let it go "
                        "by calls.");
    return handle;
  }

  std::set<unsigned int>
  Handles::shared_nodes() const
  {
    std::set<unsigned int> seen, shared;
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.held_nodes())
        if (!seen.insert(node).second)
          shared.insert(node);
    return shared;
  }

  void
  Handles::refuse_shared_catches(const double time) const
  {
    std::map<unsigned int, const Handle *> holders;
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.held_nodes())
        for (const unsigned int c : handle.components)
        {
          const auto [first, is_new] = holders.emplace(3 * node + c, &handle);
          const Handle &other        = *first->second;
          const Handle &catching     = handle.time.has_caught(time, rounding) ? handle : other;
          if (!is_new && catching.time.has_caught(time, rounding))
            throw UserError("Handles '" + other.name + "' and '" + handle.name + "' both hold "
                            + name_of_node(node, mesh, fe_space) + " at t = " + shortest_text(time)
                            + ", which '" + catching.name
                            + "' catches wherever it is then. Let the other one go before (Handles/"
                            + (&catching == &handle ? other : handle).name
                            + "/Until), or change a Select so that they do not overlap.");
        }
  }

  void
  Handles::check_overlaps(const TimeAxis &axis)
  {
    follow_time(axis.time(0));
    std::set<unsigned int> shared = shared_nodes();
    for (unsigned int step = 0; step <= axis.n_steps() && (!shared.empty() || have_times()); ++step)
    {
      const double begin = axis.time(std::max(step, 1U) - 1);
      if (follow_time(begin) || step == 0)
      {
        shared = shared_nodes();
        if (have_times())
          refuse_shared_catches(begin);
      }
      if (!shared.empty())
        check_agreement(shared, displacements(axis.time(step)), axis.time(step));
    }
    follow_time(axis.time(0));
  }

  void
  Handles::look_for_idle_times(const TimeAxis &axis)
  {
    for (const Handle &handle : handles)
    {
      bool holds = false;
      for (unsigned int step = 0; step < axis.n_steps() && !holds; ++step)
        holds = handle.time.holds(axis.time(step), rounding);
      if (!holds)
        warnings.push_back(
            "Handles/" + handle.name + " holds in no step: none begins between From = "
            + shortest_text(handle.time.from) + " and Until = " + shortest_text(handle.time.until)
            + " s. Times of a scene that is not dynamic go from 0 to 1.");
    }
  }
} // namespace Exemplar
