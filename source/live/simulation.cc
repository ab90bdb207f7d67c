// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/simulation.h>
#include <exemplar/run/problem/obstacle_start.h>

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>
#include <system_error>

namespace Exemplar::Live
{
  namespace
  {
    /// The name of the colouring by the distance from a pose.
    std::string
    name_of_pose(const unsigned int pose)
    {
      return fmt::format("pose {}", pose);
    }

    /// Colours span at least as much as this strain makes, so that the rounding of a body at rest is not seen.
    constexpr double least_strain = 1e-4;

    /// Lengths of the vectors of a field of nodes at the vertices.
    std::vector<double>
    lengths(const Vector &field, const BodySurface &surface)
    {
      std::vector<double> result;
      for (const unsigned int node : surface.nodes)
        result.push_back(std::hypot(field[3 * node], field[3 * node + 1], field[3 * node + 2]));
      return result;
    }

    /// Distances of the vertices from a pose that is translated to the mean place of the body.
    std::vector<double>
    distances(const Vector &positions, const Vector &pose, const BodySurface &surface)
    {
      dealii::Tensor<1, 3> between;
      const auto           difference = [&](const unsigned int node)
      {
        dealii::Tensor<1, 3> d;
        for (unsigned int c = 0; c < 3; ++c)
          d[c] = positions[3 * node + c] - pose[3 * node + c];
        return d;
      };
      for (const unsigned int node : surface.nodes)
        between += difference(node) / static_cast<double>(surface.nodes.size());
      std::vector<double> result;
      for (const unsigned int node : surface.nodes)
        result.push_back((difference(node) - between).norm());
      return result;
    }
  } // namespace

  Simulation::Simulation(Stage &stage, Mailbox &mailbox, Outbox outbox, const SpaceVector3 &up)
      : stage(stage), mailbox(mailbox), outbox(std::move(outbox)), up(up),
        surface(stage.get_problem().body.mesh), skin(stage.get_problem(), surface),
        obstacles(stage.get_problem(), up), hand(stage.get_problem(), surface),
        pace(stage.get_step_size())
  {
  }

  Welcome
  Simulation::welcome() const
  {
    const Problem      &problem  = stage.get_problem();
    std::vector<Bytes>  binaries = { topology_message(surface) };
    const ExamplePoses &poses    = problem.examples.poses;
    for (unsigned int i = 0; i < poses.size(); ++i)
      binaries.push_back(skin.beside(frame_message({ BinaryKind::pose, i }, surface, poses.pose(i)),
                                     poses.pose(i)));
    for (const Bytes &bytes : obstacles.welcome(problem))
      binaries.push_back(bytes);
    binaries.push_back(
        skin.beside(frame_message({}, surface, problem.state.positions), problem.state.positions));
    return { scene_text(stage, hand, surface, skin, up),
             state_text(stage, hand, surface, obstacles, wish), binaries };
  }

  void
  Simulation::run()
  {
    bool was_active = false;
    for (bool is_active = false; !mailbox.is_stopped(); was_active = is_active)
    {
      is_active = mailbox.get_n_viewers() > 0 && (!wish.is_paused || n_single_steps > 0);
      if (is_active && !was_active)
        pace.restart();
      const bool is_due = is_active && pace.is_due();
      const auto until  = is_active ? pace.get_due() : Pace::Clock::now() + std::chrono::seconds(1);
      for (const Command &command : mailbox.take(!is_due, until))
        obey(command);
      if (obstacles.are_old(stage.get_problem()))
        show_frame();
      if (state_is_new)
        show_state();
      if (is_due)
        make_step();
      else if (pace.wants_status())
        show_status();
    }
    stage.save();
  }

  void
  Simulation::obey(const Command &command)
  {
    state_is_new = state_is_new || command.type != "move"; // even if refused, as sliders have moved
    try
    {
      if (command.type == "pause")
        wish.is_paused = command.on;
      else if (command.type == "step")
        n_single_steps += wish.is_paused ? 1 : 0;
      else if (command.type == "reset")
        begin_anew();
      else if (command.type == "undo")
        undo();
      else if (command.type == "colour")
        choose_colour(command.name);
      else if (command.type == "save pose")
        save_pose();
      else if (command.type == "add example")
        add_example();
      else if (command.type == "let go of all")
        stage.act(hand.let_go_of_all(stage.get_problem()));
      else
        touch(command);
    }
    catch (const std::invalid_argument &refusal)
    {
      tell("refused", command.type + ": " + refusal.what() + ".");
    }
    catch (const UserError &refusal)
    {
      tell("refused", command.type + ": " + refusal.what());
    }
    catch (const SolverFailure &failure) // the body may be partly changed
    {
      begin_anew();
      tell("warning", std::string(failure.what()) + " The body is at its beginning again.");
    }
  }

  void
  Simulation::touch(const Command &command)
  {
    const bool begins
        = !hand.pulls()
          && (command.type == "grab" || command.type == "pin" || command.type == "unpin"
              || command.type == "put" || command.type == "take away");
    const Hand::Held before = hand.get_held();
    try
    {
      const Session events = hand.events_of(command, stage.get_problem());
      if (begins)
        keep_moment(before);
      stage.act(events);
    }
    catch (...)
    {
      hand.restore(before);
      throw;
    }
    if (command.type == "move" || command.type == "grab")
      shown.pointer = command.sequence;
  }

  void
  Simulation::keep_moment(const Hand::Held &held)
  {
    try
    {
      stage.keep_moment();
      held_before.push_back(held);
    }
    catch (const std::system_error &error) // a full disk is no reason to end a session
    {
      tell("warning", std::string(error.what()) + ". Undo does not come back to here.");
    }
  }

  void
  Simulation::make_step()
  {
    const auto       begin  = Pace::now();
    const Hand::Held before = hand.get_held();
    std::string      failure;
    try
    {
      stage.act(hand.follow(stage.get_problem()));
      shown.report = stage.advance();
      if (!is_success(shown.report.status))
        failure = stage.get_problem().failure_message(shown.report);
    }
    catch (const UserError &error) // for instance handles that disagree
    {
      failure = error.what();
    }
    catch (const SolverFailure &error)
    {
      failure = error.what();
    }
    n_single_steps -= n_single_steps > 0 ? 1 : 0;
    pace.add_step(begin);
    n_failures = failure.empty() ? 0 : n_failures + 1;
    if (failure.empty())
      show_frame();
    else
      recover(failure, before);
    if (pace.wants_status())
      show_status();
  }

  void
  Simulation::recover(const std::string &message, const Hand::Held &before)
  {
    state_is_new = true;
    if (n_failures > 2)
    {
      begin_anew();
      wish.is_paused = true;
      tell("warning", message + " The body is at its beginning again, and the simulation pauses.");
      return;
    }
    const Hand::Held &held        = hand.get_held();
    const bool        has_dragged = !held.handles.empty() || !held.obstacles.empty();
    stage.act(hand.let_go_of_all(stage.get_problem()));
    stage.act(hand.stop_handles(before, stage.get_problem()));
    stage.forget();
    tell("warning", message + " Everything that pulled has let go"
                        + (has_dragged ? ", and what was dragged stops here." : "."));
  }

  void
  Simulation::undo()
  {
    if (!stage.go_back())
      throw std::invalid_argument("nothing is kept to go back to");
    const std::size_t n = stage.n_moments();
    hand.restore(held_before[held_before.size() - 1]);
    held_before.pop_back();
    held_before.erase(held_before.begin(), held_before.end() - static_cast<std::ptrdiff_t>(n));
    pace.restart();
    show_frame();
  }

  void
  Simulation::begin_anew()
  {
    stage.begin_anew();
    hand.restore({});
    held_before.clear();
    n_failures = 0;
    pace.restart();
    show_frame();
  }

  void
  Simulation::save_pose()
  {
    Recording *const recording = stage.get_recording();
    if (recording == nullptr)
      throw std::invalid_argument("poses are saved by a server that was started with --record DIR");
    tell("saved", recording->save_pose(stage.get_problem()).string());
  }

  void
  Simulation::add_example()
  {
    const std::string name = stage.add_example();
    hand.restore({});
    held_before.clear();
    n_failures = 0;
    pace.restart();
    show_obstacles();
    outbox.welcome(welcome());
    show_frame();
    tell("warning", "The body begins anew, with this pose as its example " + name + ".");
  }

  void
  Simulation::choose_colour(const std::string &name)
  {
    bool is_known = name == "none" || name == "energy" || name == "det F"
                    || (name == "contact" && !touching_terms(stage.get_problem()).empty());
    for (unsigned int i = 0; i < stage.get_problem().examples.poses.size(); ++i)
      is_known = is_known || name == name_of_pose(i);
    if (!is_known)
      throw std::invalid_argument("there is no such colour");
    wish.colour = name;
  }

  Colours
  Simulation::colours() const
  {
    Problem     &problem  = stage.get_problem();
    const double diameter = problem.body.mesh.diameter(), young = young_of(problem).mean;
    if (wish.colour == "energy" || wish.colour == "det F")
    {
      const bool        is_energy = wish.colour == "energy";
      const CellResults cells
          = problem.elastic->cell_results(problem.state.positions, problem.state.weights);
      return { at_vertices(is_energy ? cells.strain_energy_density : cells.det_F, problem.body.mesh,
                           surface),
               is_energy ? 0.5 * young * least_strain * least_strain : least_strain };
    }
    if (wish.colour == "contact")
      return { lengths(contact_forces(problem), surface),
               young * std::pow(least_strain * diameter, 2) };
    for (unsigned int i = 0; i < problem.examples.poses.size(); ++i)
      if (wish.colour == name_of_pose(i))
        return { distances(problem.state.positions, problem.examples.poses.pose(i), surface),
                 least_strain * diameter };
    return {};
  }

  void
  Simulation::show_frame()
  {
    show_obstacles();
    const State &state = stage.get_problem().state;
    const Bytes  frame = frame_message(
         { BinaryKind::frame, ++shown.n_frames, state.step, shown.pointer, state.time }, surface,
         state.positions, colours());
    outbox.frame(skin.beside(obstacles.beside(frame, stage.get_problem()), state.positions));
  }

  void
  Simulation::show_obstacles()
  {
    const Problem &problem = stage.get_problem();
    if (!obstacles.are_old(problem))
      return;
    obstacles             = ObstacleFrames(problem, up);
    std::vector<Bytes> of = obstacles.welcome(problem);
    if (of.empty()) // a surface without triangles, instead of the one that viewers have
      of.push_back(topology_message(BodySurface(), BinaryKind::topology_of_obstacles));
    outbox.obstacles(welcome(), of);
    state_is_new = true;
  }

  void
  Simulation::show_state()
  {
    outbox.text(state_text(stage, hand, surface, obstacles, wish));
    state_is_new = false;
  }

  void
  Simulation::show_status()
  {
    outbox.text(
        status_text(stage.get_problem(), hand, shown.report, pace.summary(), wish.is_paused));
  }

  void
  Simulation::tell(const std::string &type, const std::string &text) const
  {
    outbox.text(words_text(type, text));
  }
} // namespace Exemplar::Live
