// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_part.h>

#include <algorithm>
#include <utility>

namespace Exemplar
{
  MeshPart
  part_of(const Mesh                      &whole,
          const std::vector<unsigned int> &nodes,
          const std::vector<unsigned int> &cells,
          const std::vector<unsigned int> &faces,
          const std::vector<unsigned int> &further_faces)
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
    own.further_faces           = chosen(whole.get_further_faces(), further_faces);
    for (auto &cell : own.cells)
      renumber(cell);
    for (std::vector<BoundaryFace> *const some : { &own.boundary_faces, &own.further_faces })
      for (BoundaryFace &face : *some)
        renumber(face.nodes);
    for (const unsigned int cell : cells)
      own.element_numbers.push_back(whole.element_number(cell));
    return part;
  }

  CellOrder::CellOrder(std::vector<unsigned int> in_file,
                       const unsigned int        n_cells,
                       const Exchange           &exchange)
      : places(std::move(in_file)), n_of_whole(n_cells), exchange(&exchange)
  {
  }

  std::vector<double>
  CellOrder::whole(const std::vector<double> &own) const
  {
    const std::size_t   n = own.size() / places.size(); // values of each cell
    std::vector<double> all(n * n_of_whole, 0.);
    for (std::size_t cell = 0; cell < places.size(); ++cell)
      std::copy_n(own.begin() + n * cell, n, all.begin() + n * places[cell]);
    exchange->sum(all);
    return all;
  }

  std::vector<double>
  CellOrder::part(const std::vector<double> &of_whole_body) const
  {
    const std::size_t   n = of_whole_body.size() / n_of_whole; // values of each cell
    std::vector<double> own(n * places.size());
    for (std::size_t cell = 0; cell < places.size(); ++cell)
      std::copy_n(of_whole_body.begin() + n * places[cell], n, own.begin() + n * cell);
    return own;
  }
} // namespace Exemplar
