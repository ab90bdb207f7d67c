// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/problem/session_player.h>

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace Exemplar
{
  namespace
  {
    constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

    dealii::Point<3>
    point_at(const std::vector<double> &numbers, const std::size_t first)
    {
      return { numbers[first], numbers[first + 1], numbers[first + 2] };
    }

    std::string
    title(const SessionEvent &event)
    {
      return "Session, step " + std::to_string(event.step) + ", " + in_quotes(event.what)
             + (event.name.empty() ? "" : " of " + in_quotes(event.name));
    }
  } // namespace

  const std::map<std::string, SessionPlayer::Verb> SessionPlayer::verbs
      = { { "grab", { &SessionPlayer::grab, any_number, any_number } },
          { "move", { &SessionPlayer::move, 0, 3 } },
          { "release", { &SessionPlayer::release, 0, 0 } },
          { "hold", { &SessionPlayer::hold, any_number, any_number } },
          { "shift", { &SessionPlayer::shift, 0, 3 } },
          { "let go", { &SessionPlayer::let_go, 0, 0 } },
          { "young", { &SessionPlayer::set_material, 0, 1 } },
          { "poisson", { &SessionPlayer::set_material, 0, 1 } },
          { "density", { &SessionPlayer::set_material, 0, 1 } },
          { "importance", { &SessionPlayer::set_importance, 0, 1 } },
          { "weights", { &SessionPlayer::hold_weights, 0, any_number } },
          { "gravity", { &SessionPlayer::set_gravity, 0, 3 } },
          { "damping", { &SessionPlayer::set_damping, 0, 2 } },
          { "forget", { &SessionPlayer::forget, 0, 0 } } };

  SessionPlayer::SessionPlayer(Problem &problem)
      : problem(problem), springs(std::make_shared<Springs>())
  {
    if (problem.body.exchange().n_processes() > 1)
      throw UserError("Session/File: sessions are played by one process. Call exemplar without "
                      "mpirun.");
    problem.add_term([springs = springs] { return std::make_unique<SpringTerm>(springs); });
  }

  void
  SessionPlayer::apply(const SessionEvent &event)
  {
    const auto verb = verbs.find(event.what);
    if (verb == verbs.end())
      throw UserError(title(event) + ": this cannot be done to a body.");
    const auto &[act, n_nodes, n_numbers] = verb->second;
    if ((n_nodes != any_number && event.nodes.size() != n_nodes)
        || (n_numbers != any_number && event.numbers.size() != n_numbers))
      throw UserError(fmt::format("{}: it has {} nodes and {} numbers, which is not what it takes.",
                                  title(event), event.nodes.size(), event.numbers.size()));
    for (const unsigned int node : event.nodes)
      if (node >= problem.body.mesh.n_nodes())
        throw UserError(fmt::format("{}: there is no node {}; nodes are counted from 0, and there "
                                    "are {}. Was it recorded with another mesh?",
                                    title(event), node, problem.body.mesh.n_nodes()));
    (this->*act)(event);
  }

  void
  SessionPlayer::play(Session session)
  {
    recorded = std::move(session);
    n_played = 0;
  }

  void
  SessionPlayer::begin_step()
  {
    for (; n_played < recorded.size() && recorded[n_played].step <= problem.state.step + 1;)
      apply(recorded[n_played++]);
  }

  void
  SessionPlayer::catch_up(const unsigned int step)
  {
    if (n_played > 0 && recorded[n_played - 1].step > step + 1)
      throw UserError("A scene with a Session/File does not go back. Make the problem anew.");
    LastingEvents until_there;
    for (; n_played < recorded.size() && recorded[n_played].step <= step;)
      until_there.add(recorded[n_played++]);
    catch_up(until_there);
  }

  void
  SessionPlayer::catch_up(const LastingEvents &events)
  {
    for (const SessionEvent &event : events.get())
      apply(event);
  }

  void
  SessionPlayer::grab(const SessionEvent &event)
  {
    const std::size_t n = event.nodes.size();
    if (n == 0 || event.numbers.size() != 4 * n + 4)
      throw UserError(title(event)
                      + ": it takes nodes, four numbers for each, an anchor and a stiffness.");
    Spring spring{ {}, point_at(event.numbers, 4 * n), event.numbers.back() };
    for (std::size_t i = 0; i < n; ++i)
      spring.ends.push_back(
          { event.nodes[i], event.numbers[4 * i], point_at(event.numbers, 4 * i + 1) });
    const bool has_shares = std::all_of(spring.ends.begin(), spring.ends.end(),
                                        [](const Spring::End &end) { return end.share >= 0.; });
    if (!has_shares || !(spring.stiffness > 0.))
      throw UserError(title(event)
                      + ": the stiffness of a spring must be above 0, and no share below it.");
    (*springs)[event.name] = std::move(spring);
    problem.solver->forget(); // its factors are of another matrix
  }

  void
  SessionPlayer::move(const SessionEvent &event)
  {
    const auto spring = springs->find(event.name);
    if (spring == springs->end())
      throw UserError(title(event) + ": there is no such spring.");
    spring->second.anchor = point_at(event.numbers, 0);
  }

  void
  SessionPlayer::release(const SessionEvent &event)
  {
    if (springs->erase(event.name) == 0)
      throw UserError(title(event) + ": there is no such spring.");
    problem.solver->forget();
  }

  void
  SessionPlayer::hold(const SessionEvent &event)
  {
    const std::vector<unsigned int> &nodes = event.nodes;
    if (nodes.empty() || event.numbers.size() != 3 * nodes.size()
        || !std::is_sorted(nodes.begin(), nodes.end(), std::less_equal<>()))
      throw UserError(title(event)
                      + ": it takes nodes in ascending order and three numbers for each.");
    const auto place = std::make_shared<Place>();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      place->displacements.push_back(point_at(event.numbers, 3 * i));
    problem.change_handles(
        [&](Handles &handles)
        {
          for (unsigned int handle = 0; handle < handles.size(); ++handle)
            if (handles.name(handle) == event.name)
              handles.let_go(event.name);
          handles.grab(event.name, nodes,
                       [place](const std::vector<dealii::Point<3>> &, double)
                       {
                         std::vector<dealii::Tensor<1, 3>> moved = place->displacements;
                         for (dealii::Tensor<1, 3> &displacement : moved)
                           displacement += place->shift;
                         return moved;
                       });
        });
    places[event.name] = place;
  }

  void
  SessionPlayer::shift(const SessionEvent &event)
  {
    const auto place = places.find(event.name);
    if (place == places.end())
      throw UserError(title(event) + ": no such handle was held by hand.");
    place->second->shift = point_at(event.numbers, 0);
  }

  void
  SessionPlayer::let_go(const SessionEvent &event)
  {
    problem.change_handles([&](Handles &handles) { handles.let_go(event.name); });
    places.erase(event.name);
  }

  void
  SessionPlayer::set_material(const SessionEvent &event)
  {
    ChangedConstants changed;
    (event.what == "young"     ? changed.youngs_modulus
     : event.what == "poisson" ? changed.poissons_ratio
                               : changed.density)
        = event.numbers;
    problem.set_material(changed);
  }

  void
  SessionPlayer::set_importance(const SessionEvent &event)
  {
    problem.set_importance(event.numbers[0]);
  }

  void
  SessionPlayer::hold_weights(const SessionEvent &event)
  {
    problem.hold_weights(event.numbers);
  }

  void
  SessionPlayer::set_gravity(const SessionEvent &event)
  {
    problem.set_gravity({ { event.numbers[0], event.numbers[1], event.numbers[2] } });
  }

  void
  SessionPlayer::set_damping(const SessionEvent &event)
  {
    problem.set_damping(event.numbers[0], event.numbers[1]);
  }

  void
  SessionPlayer::forget(const SessionEvent & /*event*/)
  {
    problem.resume_from(State(problem.state));
  }
} // namespace Exemplar
