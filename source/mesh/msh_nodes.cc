// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/mesh/msh_nodes.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  void
  remove_nodes(MshFile &msh, const std::vector<bool> &keep)
  {
    std::vector<std::size_t> index(keep.size());
    std::size_t              n = 0;
    for (std::size_t i = 0; i < keep.size(); ++i)
    {
      index[i] = n;
      if (!keep[i])
        continue;
      msh.nodes[n]        = msh.nodes[i];
      msh.node_numbers[n] = msh.node_numbers[i];
      ++n;
    }
    msh.nodes.resize(n);
    msh.node_numbers.resize(n);
    for (MshElement &element : msh.elements)
      for (std::size_t &node : element.nodes)
        node = index[node];
  }

  void
  drop_construction_points(MshFile &msh, const std::string &name)
  {
    const auto is_plain_point = [](const MshElement &element)
    { return element.type == MshElementType::point && element.physical == 0; };
    std::vector<bool> is_used(msh.nodes.size(), false), keep(msh.nodes.size(), true);
    for (const MshElement &element : msh.elements)
      if (!is_plain_point(element))
        for (const std::size_t node : element.nodes)
          is_used[node] = true;
    std::vector<std::size_t> dropped;
    for (const MshElement &element : msh.elements)
      if (is_plain_point(element) && !is_used[element.nodes[0]] && keep[element.nodes[0]])
      {
        keep[element.nodes[0]] = false;
        dropped.push_back(msh.node_numbers[element.nodes[0]]);
      }
    if (dropped.empty() || dropped.size() == msh.nodes.size())
      return;
    msh.elements.erase(std::remove_if(msh.elements.begin(), msh.elements.end(),
                                      [&](const MshElement &element) {
                                        return is_plain_point(element) && !keep[element.nodes[0]];
                                      }),
                       msh.elements.end());
    remove_nodes(msh, keep);
    msh.note
        += fmt::format("{}{}: {} of a geometry in no other element {} left out: node {}.",
                       msh.note.empty() ? "" : " ", name,
                       dropped.size() == 1 ? "a point" : fmt::format("{} points", dropped.size()),
                       dropped.size() == 1 ? "is" : "are", list_numbers(dropped));
  }
} // namespace Exemplar
