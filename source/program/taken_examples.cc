// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>
#include <exemplar/program/taken_examples.h>
#include <exemplar/run/output/weight_names.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// A weight below which an example can hardly be seen.
    constexpr double little = 0.05;

    /// Greatest weight of each example in any region.
    std::vector<double>
    greatest_of_regions(const Problem &problem)
    {
      std::vector<double>        greatest(problem.examples.poses.size(), 0.);
      const std::vector<double> &weights = problem.state.weights;
      for (std::size_t weight = 0; weight < weights.size(); ++weight)
      {
        double &of_example = greatest[weight % greatest.size()];
        of_example         = std::max(of_example, weights[weight]);
      }
      return greatest;
    }
  } // namespace

  TakenExamples::TakenExamples(const Problem &problem)
      : problem(problem), first_step(problem.state.step),
        greatest(problem.examples.poses.size(), 0.)
  {
  }

  void
  TakenExamples::add_step()
  {
    ++n_steps;
    const std::vector<double> now = greatest_of_regions(problem);
    for (std::size_t i = 0; i < greatest.size(); ++i)
      greatest[i] = std::max(greatest[i], now[i]);
  }

  std::string
  TakenExamples::text() const
  {
    const ExamplePoses &poses = problem.examples.poses;
    if (problem.examples.weights.n_unknown() == 0 || n_steps == 0)
      return "";
    std::string text = fmt::format(
        "\nWeights of examples{}{}\n", poses.n_regions() > 1 ? ", the greatest of all regions" : "",
        first_step > 0 ? fmt::format(", after step {}", first_step) : "");
    const std::vector<double> last         = greatest_of_regions(problem);
    bool                      any_is_taken = false;
    for (unsigned int i = 0; i < poses.size(); ++i)
    {
      if (!poses.is_strained(i))
        continue;
      any_is_taken = any_is_taken || greatest[i] >= little;
      text += fmt::format(
          "  {:<24} up to {:.3f}, at the end {:.3f}\n",
          fmt::format("{} ({})", poses.number(i), printable(short_name_of_pose(poses, i))),
          greatest[i], last[i]);
    }
    if (!any_is_taken)
      text += "  The examples had hardly any effect: all weights are below 0.05. "
              "See doc/importance.md, Weights below 5 %.\n";
    return text;
  }
} // namespace Exemplar
