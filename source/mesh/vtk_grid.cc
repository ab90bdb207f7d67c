// SPDX-License-Identifier: GPL-3.0-or-later
// Types of cells and orders of their nodes: VTK User's Guide, "VTK File Formats".
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/vtk_grid.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>

namespace Exemplar
{
  namespace
  {
    /// gmsh's type of a cell of VTK; 0 for kinds that have none here.
    unsigned int
    gmsh_type_of_vtk(const double vtk_type)
    {
      static constexpr std::pair<int, unsigned int> types[]{
        { 1, MshElementType::point },
        { 3, MshElementType::line },
        { 5, MshElementType::triangle },
        { 9, 3 },
        { 10, MshElementType::tetrahedron },
        { 12, 5 },
        { 13, 6 },
        { 14, 7 },
        { 21, MshElementType::quadratic_line },
        { 22, MshElementType::quadratic_triangle },
        { 23, 16 },
        { 24, MshElementType::quadratic_tetrahedron },
        { 25, 17 },
        { 26, 18 },
        { 27, 19 }
      };
      for (const auto &[vtk, gmsh] : types)
        if (vtk_type == vtk)
          return gmsh;
      return 0;
    }

    template <typename Number>
    std::vector<double>
    numbers_of(const std::string_view bytes, const bool is_big_endian)
    {
      std::vector<double> numbers(bytes.size() / sizeof(Number));
      for (std::size_t i = 0; i < numbers.size(); ++i)
      {
        std::array<char, sizeof(Number)> raw;
        std::memcpy(raw.data(), bytes.data() + i * sizeof(Number), sizeof(Number));
        if (is_big_endian) // all machines of ours have the other order
          std::reverse(raw.begin(), raw.end());
        Number number;
        std::memcpy(&number, raw.data(), sizeof(Number));
        numbers[i] = static_cast<double>(number);
      }
      return numbers;
    }

    struct VtkType
    {
      const char *name;
      std::size_t size;
      std::vector<double> (*convert)(std::string_view, bool);
    };

    const VtkType vtk_types[] = {
      { "Float64", 8, numbers_of<double> },
      { "double", 8, numbers_of<double> },
      { "Float32", 4, numbers_of<float> },
      { "float", 4, numbers_of<float> },
      { "Int64", 8, numbers_of<std::int64_t> },
      { "vtktypeint64", 8, numbers_of<std::int64_t> },
      { "vtktypeuint64", 8, numbers_of<std::uint64_t> },
      { "vtktypeint32", 4, numbers_of<std::int32_t> },
      { "vtktypeuint32", 4, numbers_of<std::uint32_t> },
      { "vtktypeint16", 2, numbers_of<std::int16_t> },
      { "vtktypeuint16", 2, numbers_of<std::uint16_t> },
      { "vtktypeint8", 1, numbers_of<std::int8_t> },
      { "vtktypeuint8", 1, numbers_of<std::uint8_t> },
      { "vtkIdType", 4, numbers_of<std::int32_t> }, // legacy files have 32 bits
      { "long", 8, numbers_of<std::int64_t> },
      { "UInt64", 8, numbers_of<std::uint64_t> },
      { "unsigned_long", 8, numbers_of<std::uint64_t> },
      { "Int32", 4, numbers_of<std::int32_t> },
      { "int", 4, numbers_of<std::int32_t> },
      { "UInt32", 4, numbers_of<std::uint32_t> },
      { "unsigned_int", 4, numbers_of<std::uint32_t> },
      { "Int16", 2, numbers_of<std::int16_t> },
      { "short", 2, numbers_of<std::int16_t> },
      { "UInt16", 2, numbers_of<std::uint16_t> },
      { "unsigned_short", 2, numbers_of<std::uint16_t> },
      { "Int8", 1, numbers_of<std::int8_t> },
      { "char", 1, numbers_of<std::int8_t> },
      { "UInt8", 1, numbers_of<std::uint8_t> },
      { "unsigned_char", 1, numbers_of<std::uint8_t> },
    };

    const VtkType *
    find_vtk_type(const std::string_view name)
    {
      const auto *const found
          = std::find_if(std::begin(vtk_types), std::end(vtk_types),
                         [&](const VtkType &type) { return type.name == name; });
      return found == std::end(vtk_types) ? nullptr : found;
    }

    /// Arrays of cells that programs call so hold the region; the first of these is taken.
    const std::array<const char *, 10> names_of_regions{
      { "gmsh:physical", "medit:ref", "tetgen:ref", "CellEntityIds", "MaterialIDs", "MaterialIds",
        "material", "material_id", "region", "cell_tags" }
    };

    /// Arrays by which VTK and ParaView number or mark cells, whatever they are made of.
    const std::array<const char *, 8> names_of_marks{
      { "vtkGhostType", "vtkGhostLevels", "vtkOriginalCellIds", "vtkCellIds", "GlobalElementId",
        "GlobalCellIds", "ElementId", "PedigreeElementId" }
    };

    /// Whether each cell has a number of its own, which then names no region.
    bool
    numbers_cells(const VtkArray &array)
    {
      const std::set<double> distinct(array.values.begin(), array.values.end());
      return array.values.size() > 1 && distinct.size() == array.values.size();
    }

    bool
    holds_tags(const VtkArray &array, const std::size_t n_cells)
    {
      return array.n_components == 1 && array.values.size() == n_cells
             && std::all_of(array.values.begin(), array.values.end(),
                            [](const double value) {
                              return value >= 0. && value < 2147483648.
                                     && value == std::floor(value);
                            });
    }

    std::string
    names_of(const std::vector<const VtkArray *> &arrays)
    {
      std::string text;
      for (const VtkArray *const array : arrays)
        text += (text.empty() ? "" : ", ") + in_quotes(array->name);
      return text;
    }

    const VtkArray *
    find_array(const VtkGrid &grid, const std::string &name)
    {
      for (const VtkArray &array : grid.cell_arrays)
        if (array.name == name && holds_tags(array, grid.types.size()))
          return &array;
      return nullptr;
    }

    /// The array that holds the regions, if one does, and a note on it.
    const VtkArray *
    choose_regions(const VtkGrid &grid, const std::string &name, MeshBuilder &builder)
    {
      for (const VtkArray &array : grid.cell_arrays)
        if (array.n_components == 1 && !holds_tags(array, grid.types.size())
            && std::count(names_of_regions.begin(), names_of_regions.end(), array.name) > 0)
          throw UserError(name + ": the cell array " + in_quotes(array.name)
                          + " should give the regions, which are whole numbers from 0 on, one a "
                            "cell. Correct it, or give it another name.");
      std::vector<const VtkArray *> possible;
      for (const VtkArray &array : grid.cell_arrays)
        if (holds_tags(array, grid.types.size()) && array.name != "gmsh:geometrical"
            && std::count(names_of_marks.begin(), names_of_marks.end(), array.name) == 0
            && !numbers_cells(array))
          possible.push_back(&array);
      const VtkArray *chosen = possible.size() == 1 ? possible[0] : nullptr;
      for (auto one = names_of_regions.rbegin(); one != names_of_regions.rend(); ++one)
        if (const VtkArray *const array = find_array(grid, *one))
          chosen = array;
      if (chosen != nullptr)
        builder.note(name + ": the cell array " + in_quotes(chosen->name)
                     + " gives the regions and boundaries.");
      else if (!possible.empty())
        builder.note(name + ": of the cell arrays " + names_of(possible)
                     + " none is taken for the regions; call the right one \"material\".");
      return chosen;
    }
  } // namespace

  std::size_t
  size_of_vtk_type(const std::string_view type)
  {
    const VtkType *const found = find_vtk_type(type);
    return found == nullptr ? 0 : found->size;
  }

  std::vector<double>
  vtk_numbers(const std::string_view bytes, const std::string_view type, const bool is_big_endian)
  {
    return find_vtk_type(type)->convert(bytes, is_big_endian);
  }

  MshFile
  msh_of_grid(const VtkGrid &grid, const std::string &name)
  {
    const auto fail = [&](const std::string &message) { throw UserError(name + ": " + message); };
    const std::size_t n_cells = grid.types.size();
    if (grid.points.size() % 3 != 0 || grid.offsets.size() != n_cells
        || (n_cells > 0 && grid.offsets.back() != static_cast<double>(grid.connectivity.size())))
      fail(
          fmt::format("{} coordinates, {} cells, {} ends of cells and {} nodes of cells do not fit "
                      "together. Save or copy the mesh again.",
                      grid.points.size(), n_cells, grid.offsets.size(), grid.connectivity.size()));
    MeshBuilder builder(fail);
    builder.count_from_0();
    for (std::size_t i = 0; i + 2 < grid.points.size(); i += 3)
      builder.add_node({ grid.points[i], grid.points[i + 1], grid.points[i + 2] });
    const VtkArray *const regions    = choose_regions(grid, name, builder);
    const VtkArray *const geometries = find_array(grid, "gmsh:geometrical");
    double                begin      = 0.;
    for (std::size_t cell = 0; cell < n_cells; ++cell)
    {
      const double       end  = grid.offsets[cell];
      const unsigned int type = gmsh_type_of_vtk(grid.types[cell]);
      if (type == 0)
        fail(fmt::format(
            "cell {} (from 0) has VTK's type {}. Tetrahedra are read (types 10 and 24), "
            "and triangles (5 and 22) on their boundary: Filters > Tetrahedralize of "
            "ParaView makes them of others.",
            cell, grid.types[cell]));
      const std::size_t n_nodes = find_msh_element_kind(type)->n_nodes;
      if (end - begin != static_cast<double>(n_nodes))
        fail(fmt::format("cell {} (from 0) has {} nodes, but a {} has {}. Save or copy the mesh "
                         "again.",
                         cell, end - begin, find_msh_element_kind(type)->name, n_nodes));
      std::vector<long long> nodes;
      for (std::size_t v = 0; v < n_nodes; ++v)
      {
        const double node = grid.connectivity[static_cast<std::size_t>(begin) + v];
        nodes.push_back(node >= 0. && node < 0x1p53 && node == std::floor(node)
                            ? static_cast<long long>(node)
                            : -1);
      }
      exchange_last_edges(nodes);
      const int tag = regions == nullptr ? 0 : static_cast<int>(regions->values[cell]);
      builder.add_element(type, nodes, tag);
      if (geometries != nullptr)
        builder.msh.elements.back().elementary = static_cast<int>(geometries->values[cell]);
      begin = end;
    }
    return std::move(builder.msh);
  }
} // namespace Exemplar
