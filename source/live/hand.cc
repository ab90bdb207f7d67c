// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/hand.h>
#include <exemplar/run/problem/session_form.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace Exemplar::Live
{
  namespace
  {
    /// The stiffness of a spring of strength 1, over Young's modulus times the diameter of the
    /// body.
    constexpr double relative_stiffness = 0.02;

    /// Radius of the patch that a hand takes hold of, over the diameter of the body.
    constexpr double relative_radius = 0.1;

    /// Greatest speed with which a pull follows its pointer [1/s], over the diameter of the body.
    constexpr double relative_speed = 0.4;

    /// Gains of a damped follower, for each step: wanted displacement over the distance to the
    /// pointer, and share by which the displacement approaches the wanted one. Steps predict that
    /// much; position_gain = velocity_gain / 2 makes the damping ratio about 0.7, with hardly any overshoot.
    constexpr double position_gain = 0.1, velocity_gain = 0.2;

    /// Distance below which a pull has reached its pointer, over the diameter of the body.
    constexpr double relative_nearness = 1e-5;

    constexpr std::size_t max_obstacles = 20, max_pins = 100, max_springs = 10;

    dealii::Point<3>
    place_of(const Problem &problem, const unsigned int node)
    {
      const Vector &x = problem.state.positions;
      return { x[3 * node], x[3 * node + 1], x[3 * node + 2] };
    }

    Vector
    rest_positions(const Mesh &mesh)
    {
      Vector rest(3 * mesh.n_nodes());
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          rest[3 * node + c] = mesh.get_nodes()[node][c];
      return rest;
    }

    dealii::Point<3>
    point_of(const std::vector<double> &numbers, const std::size_t first = 0)
    {
      return { numbers[first], numbers[first + 1], numbers[first + 2] };
    }

    /// The event that moves a pull to its present place.
    SessionEvent
    moved(const Problem &problem, const Hand::Pull &pull)
    {
      const auto way = pull.at - pull.from;
      return before_next_step(problem, pull.moving, pull.of, {}, { way[0], way[1], way[2] });
    }

    /// The event that holds nodes where they are: of a shell also slopes, as places of the normals' tips.
    SessionEvent
    hold_here(const Problem                   &problem,
              const std::string               &name,
              const std::vector<unsigned int> &nodes)
    {
      const FESpace      &fe_space  = problem.body.fe_space;
      const State        &state     = problem.state;
      const HeldTips     &held      = problem.constraints.held_tips; // none but in a shell
      const Vector        positions = held.empty()
                                          ? state.positions
                                          : fe_space.with_tips(state.positions, held, state.history);
      std::vector<double> displacements;
      for (const unsigned int node : nodes)
        for (unsigned int c = 0; c < 3; ++c)
          displacements.push_back(positions[3 * node + c] - fe_space.rest_position(node)[c]);
      return before_next_step(problem, "hold", name, nodes, displacements);
    }

    /// Nodes with the slopes of a shell on edges between them.
    std::vector<unsigned int>
    with_slopes(const Problem &problem, std::vector<unsigned int> nodes)
    {
      const FESpace &fe_space = problem.body.fe_space;
      return fe_space.is_shell() ? fe_space.numbering().with_middles(std::move(nodes)) : nodes;
    }

    bool
    is_free(const Problem &problem, const unsigned int node)
    {
      const FreeDofs &dofs = problem.constraints.free_dofs;
      return dofs.free_index(3 * node) != FreeDofs::held
             && dofs.free_index(3 * node + 1) != FreeDofs::held
             && dofs.free_index(3 * node + 2) != FreeDofs::held;
    }

    std::vector<unsigned int>
    free_ones(const Problem &problem, std::vector<unsigned int> nodes)
    {
      nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                                 [&](const unsigned int node) { return !is_free(problem, node); }),
                  nodes.end());
      return nodes;
    }

    /// Throws unless there is such an obstacle.
    void
    require_obstacle(const std::string &name, const Problem &problem)
    {
      const auto &obstacles = problem.actions.obstacles;
      if (obstacles == nullptr
          || std::none_of(obstacles->all.begin(), obstacles->all.end(),
                          [&](const Obstacle &obstacle)
                          { return obstacle.name() == name && !obstacle.has_left(); }))
        throw std::invalid_argument("there is no such obstacle");
    }

    std::string
    of_pin(const std::string &name)
    {
      return "pin " + name;
    }

    std::string
    of_hand(const std::string &name)
    {
      return "hand " + name;
    }
  } // namespace

  Hand::Hand(const Problem &problem, const BodySurface &surface)
      : surface(surface), diameter(problem.body.mesh.diameter()),
        stiffness(relative_stiffness * young_of(problem).mean * diameter),
        max_way(relative_speed * diameter * problem.parameters.time.step),
        rest(rest_positions(problem.body.mesh)), settings(problem)
  {
  }

  Session
  Hand::events_of(const Command &command, const Problem &problem)
  {
    if (command.type == "grab")
      return grab(command, problem);
    if (command.type == "move")
    {
      move(command);
      return {};
    }
    if (command.type == "release")
      return release(command.name, problem);
    if (command.type == "pin")
      return pin(command, problem);
    if (command.type == "unpin" && held.pins.erase(command.name) > 0)
      return { before_next_step(problem, "let go", of_pin(command.name)) };
    if (command.type == "unpin")
      throw std::invalid_argument("there is no such pin");
    if (command.type == "handle")
      return move_handle(command, problem);
    if (command.type == "put")
      return { put(command, problem) };
    if (command.type == "carry")
      return carry(command, problem);
    if (command.type == "take away")
      return take_away(command, problem);
    if (command.type == "weights")
      return { held.weights.want(command.numbers, problem) };
    return { set(command, problem) };
  }

  Session
  Hand::let_go_of_all(const Problem &problem)
  {
    Session events;
    for (const auto &entry : std::map<std::string, Pull>(held.pulls))
      events.push_back(release(entry.first, problem).front());
    return events;
  }

  Session
  Hand::follow(const Problem &problem)
  {
    Session    events      = held.weights.follow(problem);
    const auto come_nearer = [&](Pull &pull)
    {
      const dealii::Tensor<1, 3> rest_of_way = pull.to - pull.at;
      if (rest_of_way.norm() == 0.)
        return;
      dealii::Tensor<1, 3> wanted = position_gain * rest_of_way;
      wanted *= std::min(1., max_way / wanted.norm());
      pull.way += velocity_gain * (wanted - pull.way);
      const double near     = relative_nearness * diameter;
      const bool   is_there = rest_of_way.norm() < near && pull.way.norm() < near;
      pull.at               = is_there ? pull.to : pull.at + pull.way;
      events.push_back(moved(problem, pull));
    };
    for (auto *pulls : { &held.pulls, &held.handles, &held.obstacles })
      for (auto &entry : *pulls)
        come_nearer(entry.second);
    return events;
  }

  Session
  Hand::stop_handles(const Held &before, const Problem &problem)
  {
    Session    events;
    const auto stop
        = [&](std::map<std::string, Pull> &pulls, const std::map<std::string, Pull> &earlier)
    {
      for (auto &[name, pull] : pulls)
      {
        const auto found = earlier.find(name);
        pull.at = pull.to = found == earlier.end() ? pull.from : found->second.at;
        pull.way          = {};
        events.push_back(moved(problem, pull));
      }
    };
    stop(held.handles, before.handles);
    stop(held.obstacles, before.obstacles);
    return events;
  }

  SessionEvent
  Hand::put(const Command &command, const Problem &problem)
  {
    const std::size_t  n = command.numbers.size();
    const SessionEvent event
        = before_next_step(problem, n == 5 ? "ball" : "block", command.name, {}, command.numbers);
    if (n != 5 && n != 7)
      throw std::invalid_argument("an obstacle is a ball of 5 numbers or a block of 7");
    check_place(command.numbers, 0);
    if (n == 7)
      check_place(command.numbers, 3);
    const ObstacleParameters obstacle = obstacle_of(event).value();
    try
    {
      if (problem.parameters.obstacles.named.size() >= max_obstacles)
        throw std::invalid_argument("there are as many obstacles as may be");
      obstacle.check();
      if (!problem.is_clear(obstacle))
        throw std::invalid_argument("the body is there, or too near. Put it farther away");
    }
    catch (const UserError &refusal)
    {
      throw std::invalid_argument(refusal.what());
    }
    return event;
  }

  Session
  Hand::carry(const Command &command, const Problem &problem)
  {
    check_place(command.numbers, 0);
    require_obstacle(command.name, problem);
    const auto pull
        = held.obstacles
              .insert({ command.name, { "carry", "take away", command.name, {}, {}, {} } })
              .first;
    pull->second.to = point_of(command.numbers);
    return {};
  }

  Session
  Hand::take_away(const Command &command, const Problem &problem)
  {
    require_obstacle(command.name, problem);
    held.obstacles.erase(command.name);
    return { before_next_step(problem, "take away", command.name) };
  }

  double
  Hand::grab_radius() const
  {
    return relative_radius * diameter;
  }

  void
  Hand::check_place(const std::vector<double> &numbers, const std::size_t first) const
  {
    for (std::size_t i = first; i < first + 3; ++i)
      if (!(std::abs(numbers[i]) < 1e3 * diameter))
        throw std::invalid_argument("the place is too far away");
  }

  Session
  Hand::grab(const Command &command, const Problem &problem)
  {
    if (held.pulls.count(command.name) > 0)
      throw std::invalid_argument("this pointer holds the body already");
    if (held.pulls.size() >= max_springs)
      throw std::invalid_argument("the body is held by as many pointers as may be");
    if (command.triangle >= surface.triangles.size())
      throw std::invalid_argument("there is no such triangle");
    std::vector<double> numbers  = command.numbers; // shares, anchor, strength
    const auto          is_share = [](const double share) { return share >= 0. && share <= 1.; };
    if (!std::all_of(numbers.begin(), numbers.begin() + 3, is_share)
        || std::abs(numbers[0] + numbers[1] + numbers[2] - 1.) > 1e-6)
      throw std::invalid_argument("shares are not between 0 and 1 with the sum 1");
    check_place(numbers, 3);
    if (!(numbers[6] >= 1e-3 && numbers[6] <= 1e3))
      throw std::invalid_argument("the strength is not between 0.001 and 1000");

    const SurfacePoint point{ command.triangle, { { numbers[0], numbers[1], numbers[2] } } };
    const auto         patch = patch_around(point, surface, rest, grab_radius());
    const auto         place = place_of(point, surface, problem.state.positions);
    if (command.on)
      return grab_hard(command.name, place, patch, problem);
    const dealii::Point<3> to = point_of(numbers, 3);
    std::vector<double>    ends;
    for (std::size_t i = 0; i < patch.nodes.size(); ++i)
    {
      const auto offset = place_of(problem, patch.nodes[i]) - place;
      ends.insert(ends.end(), { patch.shares[i], offset[0], offset[1], offset[2] });
    }
    ends.insert(ends.end(), { place[0], place[1], place[2], numbers[6] * stiffness });
    held.pulls[command.name] = { "move", "release", command.name, {}, place, to };
    return { before_next_step(problem, "grab", command.name, patch.nodes, ends) };
  }

  Session
  Hand::grab_hard(const std::string      &name,
                  const dealii::Point<3> &place,
                  const SurfacePatch     &patch,
                  const Problem          &problem)
  {
    const std::vector<unsigned int> nodes = free_ones(problem, patch.nodes);
    if (nodes.empty())
      throw std::invalid_argument("this part of the body is held");
    held.pulls[name] = { "shift", "let go", of_hand(name), place, place, place };
    return { hold_here(problem, of_hand(name), with_slopes(problem, nodes)) };
  }

  void
  Hand::move(const Command &command)
  {
    check_place(command.numbers, 0);
    const auto pull = held.pulls.find(command.name);
    if (pull == held.pulls.end())
      throw std::invalid_argument("this pointer does not hold the body");
    pull->second.to = point_of(command.numbers);
  }

  Session
  Hand::release(const std::string &name, const Problem &problem)
  {
    const auto pull = held.pulls.find(name);
    if (pull == held.pulls.end())
      throw std::invalid_argument("this pointer does not hold the body");
    const Pull ended = pull->second;
    held.pulls.erase(pull);
    return { before_next_step(problem, ended.ending, ended.of) };
  }

  std::vector<unsigned int>
  Hand::nodes_of(const std::vector<unsigned int> &vertices) const
  {
    std::set<unsigned int> nodes;
    for (const unsigned int vertex : vertices)
    {
      if (vertex >= surface.nodes.size())
        throw std::invalid_argument("there is no such vertex");
      nodes.insert(surface.nodes[vertex]);
    }
    return { nodes.begin(), nodes.end() };
  }

  Session
  Hand::pin(const Command &command, const Problem &problem)
  {
    if (held.pins.count(command.name) > 0)
      throw std::invalid_argument("there is a pin of this name");
    if (held.pins.size() >= max_pins)
      throw std::invalid_argument("there are as many pins as may be");
    const std::vector<unsigned int> nodes = free_ones(problem, nodes_of(command.vertices));
    if (nodes.empty())
      throw std::invalid_argument("all of this is held already");
    held.pins[command.name] = nodes;
    return { hold_here(problem, of_pin(command.name), with_slopes(problem, nodes)) };
  }

  Session
  Hand::move_handle(const Command &command, const Problem &problem)
  {
    check_place(command.numbers, 0);
    const Handles &all = problem.constraints.handles;
    for (unsigned int handle = 0; handle < all.size(); ++handle)
      if (all.name(handle) == command.name)
      {
        const auto [pull, is_new] = held.handles.insert(
            { command.name, { "shift", "let go", command.name, {}, {}, {} } });
        pull->second.to = point_of(command.numbers);
        Session events;
        if (is_new)
        {
          std::vector<unsigned int> nodes = all.nodes(handle);
          nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                                     [&](const unsigned int node) // middles follow their ends
                                     {
                                       return !problem.body.mesh.is_shell()
                                              && node >= problem.body.mesh.n_nodes();
                                     }),
                      nodes.end());
          events.push_back(hold_here(problem, command.name, nodes));
        }
        return events;
      }
    throw std::invalid_argument("there is no such handle");
  }

  SessionEvent
  Hand::set(const Command &command, const Problem &problem)
  {
    const SessionEvent event = settings.event_of(command, problem);
    if (command.name == "importance" && !settings.is_without_examples(problem))
      held.importance = problem.parameters.examples.importance;
    return event;
  }

  double
  Hand::importance_with_examples(const Problem &problem) const
  {
    return settings.is_without_examples(problem) ? held.importance
                                                 : problem.parameters.examples.importance;
  }
} // namespace Exemplar::Live
