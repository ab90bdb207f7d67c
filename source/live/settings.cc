// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/exemplar.h>
#include <exemplar/live/settings.h>

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

namespace Exemplar::Live
{
  namespace
  {
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

  SessionEvent
  Settings::event_of(const Command &command, const Problem &problem) const
  {
    if (command.type == "gravity" || command.type == "damping")
      return before_next_step(problem, command.type, "", {}, command.numbers);
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
