// SPDX-License-Identifier: GPL-3.0-or-later
// Format: https://gmsh.info/doc/texinfo/gmsh.html, "File formats".
#include <exemplar/mesh/msh_reader.h>

// Sections of version 2.2.

namespace Exemplar
{
  void
  MshReader::read_nodes_2()
  {
    const std::size_t n_nodes = in.text_size();
    if (in.is_binary())
      in.end_line();
    begin_items(n_nodes, "nodes");
    for (std::size_t i = 0; i < n_nodes; ++i)
    {
      msh.node_numbers.push_back(in.read_int_as_size());
      read_coordinates(msh.node_numbers.back());
    }
  }

  void
  MshReader::read_elements_2()
  {
    const std::size_t n_elements = in.text_size();
    if (in.is_binary())
      in.end_line();
    begin_items(n_elements, "elements");
    while (msh.elements.size() < n_elements)
    {
      MshElement element{};
      // In ASCII the number comes first; in binary a header serves many elements.
      if (!in.is_binary())
        element.number = in.read_int_as_size();
      element.type             = static_cast<unsigned int>(in.read_int_as_size());
      const std::size_t n_same = in.is_binary() ? in.read_int_as_size() : 1;
      const std::size_t n_tags = in.read_int_as_size();
      const auto       &kind   = kind_of(element.type);
      for (std::size_t i = 0; i < n_same; ++i)
      {
        if (in.is_binary())
          element.number = in.read_int_as_size();
        for (std::size_t k = 0; k < n_tags; ++k)
        {
          const int tag = checked_tag(in.read_int());
          if (k < 2) // the others are partitions
            (k == 0 ? element.physical : element.elementary) = tag;
        }
        read_element_nodes(element, kind.n_nodes);
      }
    }
    require_all(msh.elements.size(), n_elements);
  }
} // namespace Exemplar
