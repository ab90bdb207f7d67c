// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vtk_grid_h
#define exemplar_vtk_grid_h

#include <exemplar/mesh/mesh_builder.h>

#include <string>
#include <string_view>
#include <vector>

// What the two formats of VTK share.

namespace Exemplar
{
  /// An array of numbers; whole ones are exact up to 2^53.
  struct VtkArray
  {
    std::string         name;
    std::size_t         n_components = 1;
    std::vector<double> values;
  };

  /// An unstructured grid.
  struct VtkGrid
  {
    std::vector<double>   points;       ///< three coordinates a point
    std::vector<double>   offsets;      ///< the end of each cell in `connectivity`
    std::vector<double>   connectivity; ///< points of the cells, from 0
    std::vector<double>   types;        ///< a cell's type in VTK
    std::vector<VtkArray> cell_arrays;
  };

  /// The size of a number of a type in bytes, by either format's name; 0 for an unknown one.
  std::size_t
  size_of_vtk_type(std::string_view type);

  /// Numbers of a type in memory of one byte order.
  std::vector<double>
  vtk_numbers(std::string_view bytes, std::string_view type, bool is_big_endian);

  /// The mesh of a grid. One array of cells that holds whole numbers becomes the regions, and the
  /// note says which.
  MshFile
  msh_of_grid(const VtkGrid &grid, const std::string &name);
} // namespace Exemplar

#endif
