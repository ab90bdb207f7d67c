// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/problem/session_form.h>

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <map>

namespace Exemplar
{
  namespace
  {
    constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

    /// Numbers of nodes and numbers of a kind of event.
    struct Counts
    {
      std::size_t nodes, numbers;
    };

    const std::map<std::string, Counts> deeds = { { "grab", { any_number, any_number } },
                                                  { "move", { 0, 3 } },
                                                  { "release", { 0, 0 } },
                                                  { "hold", { any_number, any_number } },
                                                  { "shift", { 0, 3 } },
                                                  { "let go", { 0, 0 } },
                                                  { "young", { 0, 1 } },
                                                  { "poisson", { 0, 1 } },
                                                  { "density", { 0, 1 } },
                                                  { "importance", { 0, 1 } },
                                                  { "energy", { 0, 0 } },
                                                  { "tension", { 0, 1 } },
                                                  { "weights", { 0, any_number } },
                                                  { "gravity", { 0, 3 } },
                                                  { "damping", { 0, 2 } },
                                                  { "ball", { 0, 5 } },
                                                  { "block", { 0, 7 } },
                                                  { "carry", { 0, 3 } },
                                                  { "take away", { 0, 0 } },
                                                  { "forget", { 0, 0 } } };

    std::string
    names_of_deeds()
    {
      std::vector<std::string> names;
      for (const auto &entry : deeds)
        names.push_back(entry.first);
      return joined(names);
    }

    void
    check_counts(const SessionEvent &event, const std::string &title)
    {
      const auto deed = deeds.find(event.what);
      if (deed == deeds.end())
        throw UserError(title + ": this cannot be done to a body. What can: " + names_of_deeds()
                        + ".");
      const auto &[n_nodes, n_numbers] = deed->second;
      const auto expected              = [](const std::size_t n)
      { return n == any_number ? std::string("any number of") : std::to_string(n); };
      if ((n_nodes != any_number && event.nodes.size() != n_nodes)
          || (n_numbers != any_number && event.numbers.size() != n_numbers))
        throw UserError(fmt::format("{}: it has {} nodes and {} numbers, and takes {} nodes and {} "
                                    "numbers.",
                                    title, event.nodes.size(), event.numbers.size(),
                                    expected(n_nodes), expected(n_numbers)));
    }

    void
    check_grab(const SessionEvent &event, const std::string &title)
    {
      const std::size_t n = event.nodes.size();
      if (n == 0 || event.numbers.size() != 4 * n + 4)
        throw UserError(title
                        + ": it takes nodes, four numbers for each, an anchor and a stiffness.");
      bool has_shares = true;
      for (std::size_t i = 0; i < n; ++i)
        has_shares = has_shares && event.numbers[4 * i] >= 0.;
      if (!has_shares || !(event.numbers.back() > 0.))
        throw UserError(title
                        + ": the stiffness of a spring must be above 0, and no share below it.");
    }

    void
    check_hold(const SessionEvent &event, const std::string &title)
    {
      const std::vector<unsigned int> &nodes = event.nodes;
      if (nodes.empty() || event.numbers.size() != 3 * nodes.size()
          || !std::is_sorted(nodes.begin(), nodes.end(), std::less_equal<>()))
        throw UserError(title + ": it takes nodes in ascending order and three numbers for each.");
    }
  } // namespace

  std::string
  title_of(const SessionEvent &event, const std::string &file)
  {
    const std::string place
        = event.line > 0 ? fmt::format("{}:{}", file, event.line) : std::string("Session");
    return place + ", step " + std::to_string(event.step) + ", " + in_quotes(event.what)
           + (event.name.empty() ? "" : " of " + in_quotes(event.name));
  }

  void
  check_form(const SessionEvent &event, const FESpace &fe_space, const std::string &title)
  {
    check_counts(event, title);
    if (event.what == "energy" && !energy_of_name(event.name))
      throw UserError(title
                      + ": this is no energy of the examples. Allowed: scaled, blended, mixed.");
    // slopes of a shell are held as nodes of their own
    const unsigned int n_nodes = event.what == "hold" && fe_space.is_shell()
                                     ? fe_space.n_nodes()
                                     : fe_space.numbering().n_vertices();
    for (const unsigned int node : event.nodes)
      if (node >= n_nodes)
        throw UserError(fmt::format("{}: there is no node {}; nodes are counted from 0, and there "
                                    "are {}. Was it recorded with another mesh?",
                                    title, node, n_nodes));
    if (event.what == "grab")
      check_grab(event, title);
    else if (event.what == "hold")
      check_hold(event, title);
  }

  std::optional<ObstacleParameters>
  obstacle_of(const SessionEvent &event)
  {
    if (event.what != "ball" && event.what != "block")
      return {};
    ObstacleParameters obstacle;
    obstacle.name     = event.name;
    obstacle.shape    = event.what == "ball" ? "sphere" : "box";
    obstacle.friction = event.numbers.back();
    for (std::size_t i = 0; i + 1 < event.numbers.size(); ++i)
      obstacle.shape += " " + shortest_text(event.numbers[i]);
    return obstacle;
  }

  ExampleEnergy
  energy_of(const SessionEvent &event)
  {
    return energy_of_name(event.name).value();
  }

  std::optional<ChangedConstants>
  constants_of(const SessionEvent &event)
  {
    ChangedConstants changed;
    if (event.what == "young")
      changed.youngs_modulus = event.numbers;
    else if (event.what == "poisson")
      changed.poissons_ratio = event.numbers;
    else if (event.what == "density")
      changed.density = event.numbers;
    else
      return std::nullopt;
    return changed;
  }
} // namespace Exemplar
