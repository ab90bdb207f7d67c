// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/settings.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace Exemplar::Live
{
  namespace
  {
    /// Greatest speed with which weights follow their sliders [1/s].
    constexpr double speed = 3.;

    SessionEvent
    held_at(const std::vector<double> &weights, const Problem &problem)
    {
      return { problem.state.step + 1, "weights", "", {}, weights };
    }

    template <typename NumberOf>
    NumberOfCells
    over_cells(const Problem &problem, const NumberOf &number_of)
    {
      const unsigned int n     = problem.body.mesh.n_cells();
      const double       first = number_of(0);
      NumberOfCells      result{ 0., false };
      for (unsigned int cell = 0; cell < n; ++cell)
      {
        const double number = number_of(cell);
        result.mean += number / n;
        result.varies = result.varies || number != first;
      }
      if (!result.varies)
        result.mean = first; // exact to the last digit
      return result;
    }
  } // namespace

  SessionEvent
  WeightSliders::want(const std::vector<double> &values, const Problem &problem)
  {
    const ExampleWeights &weights = problem.examples.weights;
    if (!weights.are_bounded() || weights.size() == 0)
      throw std::invalid_argument("this scene has no weights that steps find within bounds");
    if (values.empty())
    {
      *this = {};
      return held_at({}, problem);
    }
    const double sum       = std::accumulate(values.begin(), values.end(), 0.);
    const auto   is_weight = [](const double weight) { return weight >= 0. && weight <= 1.; };
    if (values.size() != weights.n_per_region()
        || (!weights.are_additive() && std::abs(sum - 1.) > 1e-6)
        || !std::all_of(values.begin(), values.end(), is_weight))
      throw std::invalid_argument(weights.are_additive()
                                      ? "weights are one a key, between 0 and 1"
                                      : "weights are one an example, between 0 and 1, with the sum "
                                        "1");
    if (at.empty())
      at = problem.state.weights;
    to.clear();
    for (unsigned int region = 0; region < weights.n_regions(); ++region)
      to.insert(to.end(), values.begin(), values.end());
    return held_at(at, problem);
  }

  Session
  WeightSliders::follow(const Problem &problem)
  {
    double farthest = 0.;
    for (std::size_t i = 0; i < to.size(); ++i)
      farthest = std::max(farthest, std::abs(to[i] - at[i]));
    if (farthest == 0.)
      return {};
    const double part = speed * problem.parameters.time.step / farthest;
    for (std::size_t i = 0; i < to.size(); ++i)
      at[i] = part < 1. ? at[i] + part * (to[i] - at[i]) : to[i];
    return { held_at(at, problem) };
  }

  NumberOfCells
  young_of(const Problem &problem)
  {
    return over_cells(problem, [&](const unsigned int cell)
                      { return problem.body.material.youngs_modulus(cell); });
  }

  NumberOfCells
  poisson_of(const Problem &problem)
  {
    return over_cells(problem, [&](const unsigned int cell)
                      { return problem.body.material.of_body_alone(cell).poissons_ratio; });
  }

  Settings::Settings(const Problem &problem)
      : bounds{ { "young", { 1e-3 * young_of(problem).mean, 1e3 * young_of(problem).mean } },
                { "poisson", { 0., 0.495 } },
                { "importance", { 1e-3, 1. } } }
  {
  }

  namespace
  {
    SessionEvent
    event_of_energy(const std::string &name, const Problem &problem)
    {
      const std::optional<ExampleEnergy> energy = energy_of_name(name);
      if (!energy)
        throw std::invalid_argument("there is no such energy");
      try
      {
        problem.check_energy(*energy);
      }
      catch (const UserError &refusal)
      {
        throw std::invalid_argument(refusal.what());
      }
      return before_next_step(problem, "energy", name);
    }
  } // namespace

  SessionEvent
  Settings::event_of(const Command &command, const Problem &problem) const
  {
    if (command.type == "gravity" || command.type == "damping")
      return before_next_step(problem, command.type, "", {}, command.numbers);
    if (command.type == "tension")
    {
      try
      {
        problem.check_tension(command.name, command.numbers[0]);
      }
      catch (const UserError &refusal)
      {
        throw std::invalid_argument(refusal.what());
      }
      return before_next_step(problem, "tension", command.name, {}, command.numbers);
    }
    if (command.type == "energy")
      return event_of_energy(command.name, problem);
    const auto bound = bounds.find(command.name);
    if (command.type != "set" || bound == bounds.end())
      throw std::invalid_argument("this cannot be set");
    const auto &[min, max] = bound->second;
    if (!(command.numbers[0] >= min && command.numbers[0] <= max))
      throw std::invalid_argument(
          fmt::format("{} must be between {} and {}", command.name, min, max));
    return before_next_step(problem, command.name, "", {}, command.numbers);
  }

  bool
  Settings::is_without_examples(const Problem &problem) const
  {
    return problem.parameters.examples.importance <= bounds.at("importance").first;
  }

  SessionEvent
  before_next_step(const Problem            &problem,
                   const std::string        &what,
                   const std::string        &name,
                   std::vector<unsigned int> nodes,
                   std::vector<double>       numbers)
  {
    return { problem.state.step + 1, what, name, std::move(nodes), std::move(numbers) };
  }
} // namespace Exemplar::Live
