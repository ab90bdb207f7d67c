// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/handle_overlaps.h>
#include <exemplar/body/handles.h>

#include <algorithm>
#include <cmath>
#include <set>

// Handles with a From or Until, which release and catch nodes between steps. Which handles hold is
// a function of the time at which a step begins, and the offsets of caught nodes are one of the
// positions there, so that no history is needed.

namespace Exemplar
{
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
