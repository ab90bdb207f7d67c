// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh_builder.h>

#include <fmt/core.h>

#include <limits>

namespace Exemplar
{
  void
  MeshBuilder::add_node(const long long number, const dealii::Point<3> &place)
  {
    if (number < 0)
      fail(fmt::format("a node has the number {}. Numbers of nodes are from 0 or 1 on.", number));
    const auto unsigned_number = static_cast<std::size_t>(number);
    if (!index_of.emplace(unsigned_number, msh.nodes.size()).second)
      fail(fmt::format(
          "node number {} appears twice. Every node needs its own number: save the mesh "
          "anew.",
          number));
    msh.node_numbers.push_back(unsigned_number + static_cast<std::size_t>(1 - first));
    msh.nodes.push_back(place);
  }

  void
  MeshBuilder::add_element(const unsigned int            type,
                           const std::vector<long long> &node_numbers,
                           const int                     tag,
                           const long long               number)
  {
    const std::size_t own = number > 0 ? static_cast<std::size_t>(number) : msh.elements.size() + 1;
    if (number < 0 || (number != 0 && !element_of.emplace(own, msh.elements.size()).second))
      fail(fmt::format("element number {} {}. Every element needs its own number, from 1 on: save "
                       "the mesh anew.",
                       number, number < 0 ? "is negative" : "appears twice"));
    MshElement element{ own, type, tag, tag, {} };
    for (const long long node : node_numbers)
    {
      const auto found = node < 0 ? index_of.end() : index_of.find(static_cast<std::size_t>(node));
      if (found == index_of.end())
        fail(fmt::format(
            "element {} uses node {}, which the file does not have ({}). Save or copy "
            "the mesh again.",
            own, node,
            msh.nodes.empty()
                ? "it has no nodes before"
                : fmt::format("its {} nodes begin with number {}", msh.nodes.size(),
                              msh.node_numbers[0] - 1 + static_cast<std::size_t>(first))));
      element.nodes.push_back(found->second);
    }
    msh.elements.push_back(std::move(element));
  }

  void
  MeshBuilder::note(const std::string &sentence)
  {
    msh.note += (msh.note.empty() ? "" : " ") + sentence;
  }

  int
  MeshBuilder::tag(const long long value, const std::string &what) const
  {
    if (value < 0 || value > std::numeric_limits<int>::max())
      fail(
          fmt::format("{} is {}, but regions and boundaries have numbers from 0 to {}. Number them "
                      "anew.",
                      what, value, std::numeric_limits<int>::max()));
    return static_cast<int>(value);
  }
} // namespace Exemplar
