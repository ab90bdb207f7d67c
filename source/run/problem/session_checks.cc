// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/problem/session_checks.h>
#include <exemplar/run/problem/session_form.h>

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <set>

namespace Exemplar
{
  namespace
  {
    /// The effects of a session on a problem that later events depend on.
    class Rehearsal
    {
    public:
      explicit Rehearsal(Problem &problem)
          : problem(problem), holding(problem.constraints.handles.holding()),
            material(problem.body.material)
      {
        for (const ObstacleParameters &obstacle : problem.parameters.obstacles.named)
          obstacles.insert(obstacle.name);
      }

      Rehearsal(const Rehearsal &) = delete;
      Rehearsal &
      operator=(const Rehearsal &)
          = delete;

      ~Rehearsal()
      {
        change([this](Handles &handles) { handles.restore(holding); });
      }

      /// Throws UserError if the problem would refuse the event.
      void
      follow(const SessionEvent &event)
      {
        if (event.what == "grab")
          springs.insert(event.name);
        else if (event.what == "move" || event.what == "release")
          use_spring(event);
        else if (event.what == "hold" || event.what == "shift" || event.what == "let go")
          use_handle(event);
        else if (event.what == "ball" || event.what == "block" || event.what == "carry"
                 || event.what == "take away")
          use_obstacle(event);
        else if (event.what == "importance")
          problem.check_importance(event.numbers[0]);
        else if (event.what == "energy")
          problem.check_energy(energy_of(event));
        else if (event.what == "tension")
          problem.check_tension(event.name, event.numbers[0]);
        else if (event.what == "weights")
          problem.examples.weights.check_held(event.numbers);
        else if (event.what == "damping")
          problem.check_damping(event.numbers[0], event.numbers[1]);
        else if (const auto constants = constants_of(event))
          material = material.with(*constants);
      }

    private:
      /// Change handles as Problem::change_handles(), which also checks whether a static body may
      /// move.
      void
      change(const std::function<void(Handles &)> &action)
      {
        problem.constraints.change_handles(action, problem.parameters, problem.body);
      }

      /// Throws UserError if another handle holds one of the nodes, too.
      void
      check_free(const SessionEvent &event) const
      {
        const Handles &handles = problem.constraints.handles;
        const auto     all     = handles.holding();
        for (unsigned int handle = 0; handle < handles.size(); ++handle)
          for (const unsigned int node : all[handle].nodes)
            if (all[handle].holds && handles.name(handle) != event.name
                && std::binary_search(event.nodes.begin(), event.nodes.end(), node))
              throw UserError(
                  fmt::format("handle '{}' holds node {} already. Leave the node out, or "
                              "let go of that handle before.",
                              handles.name(handle), node));
      }

      void
      use_spring(const SessionEvent &event)
      {
        if (springs.count(event.name) == 0)
          throw UserError("there is no such spring. One is made by grab.");
        if (event.what == "release")
          springs.erase(event.name);
      }

      void
      use_obstacle(const SessionEvent &event)
      {
        if (const auto put = obstacle_of(event))
        {
          put->check();
          if (!all_names.insert(event.name).second || obstacles.count(event.name) > 0)
            throw UserError("there is an obstacle of this name already.");
          obstacles.insert(event.name);
        }
        else if (obstacles.count(event.name) == 0)
          throw UserError("there is no such obstacle. One is made by ball or block.");
        else if (event.what == "take away")
          obstacles.erase(event.name);
      }

      void
      use_handle(const SessionEvent &event)
      {
        if (event.what == "hold")
        {
          check_free(event);
          change(
              [&](Handles &handles)
              {
                for (unsigned int handle = 0; handle < handles.size(); ++handle)
                  if (handles.name(handle) == event.name)
                    handles.let_go(event.name);
                handles.grab(
                    event.name, event.nodes,
                    [](const std::vector<dealii::Point<3>> &rest, double)
                    { return std::vector<dealii::Tensor<1, 3>>(rest.size()); },
                    Handles::Edges::as_given);
              });
          held.insert(event.name);
        }
        else if (event.what == "shift" && held.count(event.name) == 0)
          throw UserError("no such handle was held by hand. One is made by hold.");
        else if (event.what == "let go")
        {
          change([&](Handles &handles) { handles.let_go(event.name); });
          held.erase(event.name);
        }
      }

      Problem                            &problem;
      const std::vector<Handles::Holding> holding; ///< of the handles at the beginning
      Material                            material;
      std::set<std::string> springs, held, obstacles; ///< by name, those that are there
      std::set<std::string> all_names;                ///< of obstacles that were put
    };
  } // namespace

  void
  check_session(Problem &problem, const Session &session, const std::string &file)
  {
    Rehearsal rehearsal(problem);
    for (const SessionEvent &event : session)
    {
      const std::string title = title_of(event, file);
      check_form(event, problem.body.fe_space, title);
      try
      {
        rehearsal.follow(event);
      }
      catch (const UserError &refusal)
      {
        throw UserError(title + ": " + refusal.what());
      }
    }
  }
} // namespace Exemplar
