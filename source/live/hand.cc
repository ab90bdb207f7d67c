// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/hand.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace Exemplar::Live
{
  namespace
  {
    /// The stiffness of a spring of strength 1, over Young's modulus times the diameter of the body.
    constexpr double relative_stiffness = 0.02;

    constexpr std::size_t max_pins = 100, max_springs = 10;

    double
    mean(const std::vector<double> &values)
    {
      double sum = 0.;
      for (const double value : values)
        sum += value;
      return sum / values.size();
    }

    double
    mean_young(const Problem &problem)
    {
      std::vector<double> all;
      for (unsigned int cell = 0; cell < problem.body.mesh.n_cells(); ++cell)
        all.push_back(problem.body.material.youngs_modulus(cell));
      return mean(all);
    }

    SessionEvent
    before_next_step(const Problem            &problem,
                     const std::string        &what,
                     const std::string        &name    = "",
                     std::vector<unsigned int> nodes   = {},
                     std::vector<double>       numbers = {})
    {
      return { problem.state.step + 1, what, name, std::move(nodes), std::move(numbers) };
    }

    dealii::Point<3>
    place_of(const Problem &problem, const unsigned int node)
    {
      const Vector &x = problem.state.positions;
      return { x[3 * node], x[3 * node + 1], x[3 * node + 2] };
    }

    /// Nodes, held where they are.
    SessionEvent
    hold_here(const Problem                   &problem,
              const std::string               &name,
              const std::vector<unsigned int> &nodes)
    {
      std::vector<double> displacements;
      for (const unsigned int node : nodes)
      {
        const auto moved = place_of(problem, node) - problem.body.mesh.get_nodes()[node];
        displacements.insert(displacements.end(), { moved[0], moved[1], moved[2] });
      }
      return before_next_step(problem, "hold", name, nodes, displacements);
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
        stiffness(relative_stiffness * mean_young(problem) * diameter), bounds{
          { "young", { 1e-3 * mean_young(problem), 1e3 * mean_young(problem) } },
          { "poisson", { 0., 0.495 } },
          { "importance", { 1e-3, 1. } }
        }
  {
  }

  Session
  Hand::events_of(const Command &command, const Problem &problem)
  {
    if (command.type == "grab")
      return grab(command, problem);
    if (command.type == "move")
      return move(command, problem);
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
    return set(command, problem);
  }

  Session
  Hand::let_go_of_all(const Problem &problem)
  {
    Session events;
    for (const std::string &name : std::set<std::string>(held.springs))
      events.push_back(release(name, problem).front());
    for (const auto &entry : std::map<std::string, dealii::Point<3>>(held.hard))
      events.push_back(release(entry.first, problem).front());
    return events;
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
    if (held.springs.count(command.name) + held.hard.count(command.name) > 0)
      throw std::invalid_argument("this pointer holds the body already");
    if (held.springs.size() + held.hard.size() >= max_springs)
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

    std::vector<unsigned int> nodes;
    for (const unsigned int vertex : surface.triangles[command.triangle])
      nodes.push_back(surface.nodes[vertex]);
    if (!command.on)
    {
      numbers[6] *= stiffness;
      held.springs.insert(command.name);
      return { before_next_step(problem, "grab", command.name, nodes, numbers) };
    }
    dealii::Point<3> place;
    for (unsigned int a = 0; a < 3; ++a)
      place += numbers[a] * (place_of(problem, nodes[a]) - dealii::Point<3>());
    std::sort(nodes.begin(), nodes.end());
    nodes = free_ones(problem, nodes);
    if (nodes.empty())
      throw std::invalid_argument("this part of the body is held");
    held.hard[command.name] = place;
    return { hold_here(problem, of_hand(command.name), nodes) };
  }

  Session
  Hand::move(const Command &command, const Problem &problem) const
  {
    check_place(command.numbers, 0);
    if (held.springs.count(command.name) > 0)
      return { before_next_step(problem, "move", command.name, {}, command.numbers) };
    const auto grabbed = held.hard.find(command.name);
    if (grabbed == held.hard.end())
      throw std::invalid_argument("this pointer does not hold the body");
    const dealii::Point<3> &from = grabbed->second;
    return { before_next_step(problem, "shift", of_hand(command.name), {},
                              { command.numbers[0] - from[0], command.numbers[1] - from[1],
                                command.numbers[2] - from[2] }) };
  }

  Session
  Hand::release(const std::string &name, const Problem &problem)
  {
    if (held.springs.erase(name) > 0)
      return { before_next_step(problem, "release", name) };
    if (held.hard.erase(name) > 0)
      return { before_next_step(problem, "let go", of_hand(name)) };
    throw std::invalid_argument("this pointer does not hold the body");
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
    held.pins.insert(command.name);
    return { hold_here(problem, of_pin(command.name), nodes) };
  }

  Session
  Hand::move_handle(const Command &command, const Problem &problem)
  {
    check_place(command.numbers, 0);
    const Handles &all = problem.constraints.handles;
    for (unsigned int handle = 0; handle < all.size(); ++handle)
      if (all.name(handle) == command.name)
      {
        Session events;
        if (held.handles.insert(command.name).second)
        {
          std::vector<unsigned int> nodes = all.nodes(handle);
          nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                                     [&](const unsigned int node)
                                     { return node >= problem.body.mesh.n_nodes(); }),
                      nodes.end());
          events.push_back(hold_here(problem, command.name, nodes));
        }
        events.push_back(before_next_step(problem, "shift", command.name, {}, command.numbers));
        return events;
      }
    throw std::invalid_argument("there is no such handle");
  }

  Session
  Hand::set(const Command &command, const Problem &problem) const
  {
    if (command.type == "gravity" || command.type == "damping")
      return { before_next_step(problem, command.type, "", {}, command.numbers) };
    const auto bound = bounds.find(command.name);
    if (command.type != "set" || bound == bounds.end())
      throw std::invalid_argument("this cannot be set");
    const auto &[min, max] = bound->second;
    if (!(command.numbers[0] >= min && command.numbers[0] <= max))
      throw std::invalid_argument(
          fmt::format("{} must be between {} and {}", command.name, min, max));
    return { before_next_step(problem, command.name, "", {}, command.numbers) };
  }
} // namespace Exemplar::Live
