// SPDX-License-Identifier: GPL-3.0-or-later
// Format: https://gmsh.info/doc/texinfo/gmsh.html, "File formats".
#include <exemplar/mesh/msh_reader.h>

#include <fmt/core.h>

#include <array>

// Sections of version 4.1.

namespace Exemplar
{
  void
  MshReader::read_entities()
  {
    std::array<std::size_t, 4> n_entities{};
    for (auto &n : n_entities)
      n = in.read_size();
    for (unsigned int dimension = 0; dimension <= 3; ++dimension)
    {
      in.begin_count(n_entities[dimension], fmt::format("entities of dimension {}", dimension));
      for (std::size_t i = 0; i < n_entities[dimension]; ++i, in.count())
      {
        const int tag = in.read_int();
        // A point's place, or the bounding box.
        for (unsigned int k = 0; k < (dimension == 0 ? 3U : 6U); ++k)
          in.read_double();
        const std::size_t n_physical = in.read_size();
        for (std::size_t k = 0; k < n_physical; ++k)
        {
          const int physical = checked_tag(in.read_int());
          if (k == 0)
            entity_physical[std::pair(dimension, tag)] = physical;
        }
        const std::size_t n_bounding = (dimension == 0) ? 0 : in.read_size();
        for (std::size_t k = 0; k < n_bounding; ++k)
          in.read_int();
      }
    }
  }

  void
  MshReader::read_nodes_4()
  {
    const std::size_t n_blocks = in.read_size();
    const std::size_t n_nodes  = in.read_size();
    in.read_size(); // smallest and largest number
    in.read_size();
    begin_items(n_nodes, "nodes");
    for (std::size_t block = 0; block < n_blocks; ++block)
    {
      const std::size_t dimension = in.read_int_as_size();
      in.read_int(); // entity
      // Nodes on an entity may have parameters on it, too.
      const std::size_t n_parameters = (in.read_int() != 0) ? dimension : 0;
      const std::size_t first        = msh.node_numbers.size();
      const std::size_t n_in_block   = in.read_size();
      for (std::size_t i = 0; i < n_in_block; ++i)
        msh.node_numbers.push_back(in.read_size());
      for (std::size_t i = 0; i < n_in_block; ++i)
      {
        read_coordinates(msh.node_numbers[first + i]);
        for (std::size_t k = 0; k < n_parameters; ++k)
          in.read_double();
      }
    }
    require_all(msh.nodes.size(), n_nodes);
  }

  void
  MshReader::read_elements_4()
  {
    const std::size_t n_blocks   = in.read_size();
    const std::size_t n_elements = in.read_size();
    in.read_size(); // smallest and largest number
    in.read_size();
    begin_items(n_elements, "elements");
    for (std::size_t block = 0; block < n_blocks; ++block)
    {
      MshElement element{};
      in.read_int(); // the entity's dimension, which is the element's
      element.elementary           = in.read_int();
      element.type                 = static_cast<unsigned int>(in.read_int_as_size());
      const std::size_t n_in_block = in.read_size();
      const auto       &kind       = kind_of(element.type);
      for (std::size_t i = 0; i < n_in_block; ++i)
      {
        element.number = in.read_size();
        read_element_nodes(element, kind.n_nodes);
      }
    }
    require_all(msh.elements.size(), n_elements);
  }

  void
  MshReader::resolve_entities()
  {
    for (auto &element : msh.elements)
    {
      const unsigned int dimension = find_msh_element_kind(element.type)->dimension;
      const auto         entity    = entity_physical.find(std::pair(dimension, element.elementary));
      if (entity != entity_physical.end())
        element.physical = entity->second;
    }
  }
} // namespace Exemplar
