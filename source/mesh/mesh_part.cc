// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_part.h>

#include <algorithm>

namespace Exemplar
{
  MeshPart
  part_of(const Mesh                      &whole,
          const std::vector<unsigned int> &nodes,
          const std::vector<unsigned int> &cells,
          const std::vector<unsigned int> &faces)
  {
    const auto renumber = [&](auto &numbers)
    {
      for (unsigned int &number : numbers)
        number = static_cast<unsigned int>(std::lower_bound(nodes.begin(), nodes.end(), number)
                                           - nodes.begin());
    };
    const MshFile &file = whole.get_contents();
    MeshPart       part;
    part.whole         = whole.whole();
    part.cells_in_file = cells;

    MeshArrays &own             = part.arrays;
    own.contents.nodes          = chosen(file.nodes, nodes);
    own.contents.node_numbers   = chosen(file.node_numbers, nodes);
    own.contents.physical_names = file.physical_names;
    own.material_ids            = chosen(whole.get_material_ids(), cells);
    own.cells                   = chosen(whole.get_cells(), cells);
    own.boundary_faces          = chosen(whole.get_boundary_faces(), faces);
    for (auto &cell : own.cells)
      renumber(cell);
    for (BoundaryFace &face : own.boundary_faces)
      renumber(face.nodes);
    for (const unsigned int cell : cells)
      own.element_numbers.push_back(whole.element_number(cell));
    return part;
  }
} // namespace Exemplar
