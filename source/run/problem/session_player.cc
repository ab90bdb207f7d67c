// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/problem/session_checks.h>
#include <exemplar/run/problem/session_form.h>
#include <exemplar/run/problem/session_player.h>

namespace Exemplar
{
  namespace
  {
    dealii::Point<3>
    point_at(const std::vector<double> &numbers, const std::size_t first)
    {
      return { numbers[first], numbers[first + 1], numbers[first + 2] };
    }
  } // namespace

  const std::map<std::string, SessionPlayer::Action> SessionPlayer::actions
      = { { "grab", &SessionPlayer::grab },       { "move", &SessionPlayer::move },
          { "release", &SessionPlayer::release }, { "hold", &SessionPlayer::hold },
          { "shift", &SessionPlayer::shift },     { "let go", &SessionPlayer::let_go } };

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
    check_form(event, problem.body.fe_space, title_of(event, file));
    problem.restart_audit("the session");
    const std::vector<double> &numbers = event.numbers;
    if (const auto constants = constants_of(event))
      problem.set_material(*constants);
    else if (const auto obstacle = obstacle_of(event))
      problem.put_obstacle(*obstacle);
    else if (event.what == "carry")
      problem.carry_obstacle(event.name, SpaceVector3({ numbers[0], numbers[1], numbers[2] }),
                             problem.parameters.time.step);
    else if (event.what == "take away")
      problem.remove_obstacle(event.name);
    else if (event.what == "importance")
      problem.set_importance(numbers[0]);
    else if (event.what == "energy")
      problem.set_energy(energy_of(event));
    else if (event.what == "tension")
      problem.set_tension(event.name, numbers[0]);
    else if (event.what == "weights")
      problem.hold_weights(numbers);
    else if (event.what == "gravity")
      problem.set_gravity({ { numbers[0], numbers[1], numbers[2] } });
    else if (event.what == "damping")
      problem.set_damping(numbers[0], numbers[1]);
    else if (event.what == "forget")
      problem.resume_from(State(problem.state));
    else
      (this->*actions.at(event.what))(event);
  }

  void
  SessionPlayer::play(Session session, std::string name)
  {
    check_session(problem, session, name);
    recorded = std::move(session);
    file     = std::move(name);
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
    Spring            spring{ {}, point_at(event.numbers, 4 * n), event.numbers.back() };
    for (std::size_t i = 0; i < n; ++i)
      spring.ends.push_back(
          { event.nodes[i], event.numbers[4 * i], point_at(event.numbers, 4 * i + 1) });
    (*springs)[event.name] = std::move(spring);
    problem.solver->forget(); // its factors are of another matrix
  }

  void
  SessionPlayer::move(const SessionEvent &event)
  {
    const auto spring = springs->find(event.name);
    if (spring == springs->end())
      throw UserError(title_of(event, file) + ": there is no such spring.");
    spring->second.anchor = point_at(event.numbers, 0);
  }

  void
  SessionPlayer::release(const SessionEvent &event)
  {
    if (springs->erase(event.name) == 0)
      throw UserError(title_of(event, file) + ": there is no such spring.");
    problem.solver->forget();
  }

  void
  SessionPlayer::hold(const SessionEvent &event)
  {
    const std::vector<unsigned int> &nodes = event.nodes;
    const auto                       place = std::make_shared<Place>();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      place->displacements.push_back(point_at(event.numbers, 3 * i));
    problem.change_handles(
        [&](Handles &handles)
        {
          for (unsigned int handle = 0; handle < handles.size(); ++handle)
            if (handles.name(handle) == event.name)
              handles.let_go(event.name);
          handles.grab(
              event.name, nodes,
              [place](const std::vector<dealii::Point<3>> &, double)
              {
                std::vector<dealii::Tensor<1, 3>> moved = place->displacements;
                for (dealii::Tensor<1, 3> &displacement : moved)
                  displacement += place->shift;
                return moved;
              },
              Handles::Edges::as_given);
        });
    places[event.name] = place;
  }

  void
  SessionPlayer::shift(const SessionEvent &event)
  {
    const auto place = places.find(event.name);
    if (place == places.end())
      throw UserError(title_of(event, file) + ": no such handle was held by hand.");
    place->second->shift = point_at(event.numbers, 0);
  }

  void
  SessionPlayer::let_go(const SessionEvent &event)
  {
    problem.change_handles([&](Handles &handles) { handles.let_go(event.name); });
    places.erase(event.name);
  }
} // namespace Exemplar
