// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/confinement.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/process_copy.h>
#include <exemplar/base/text_file.h>
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_faults.h>
#include <exemplar/surface/shape/surface_mesh.h>

#include <fmt/core.h>

#include <set>
#include <sstream>
#include <tuple>

namespace Exemplar
{
  namespace
  {
    constexpr double max_seconds = 600.; // [s]; checks of a million faces take seconds

    SurfaceMesh::Vertex
    place_of(const FaultyElement &element, const SurfaceMesh &surface)
    {
      if (!element.is_face)
        return surface.vertices[element.index];
      const std::vector<unsigned int> &corners = surface.faces[element.index];
      SurfaceMesh::Vertex              middle{};
      for (const unsigned int corner : corners)
        for (unsigned int d = 0; d < 3; ++d)
          middle[d] += surface.vertices[corner][d] / static_cast<double>(corners.size());
      return middle;
    }

    CsvRow
    row_of(const FaultyElement &element, const SurfaceMesh &surface)
    {
      const SurfaceMesh::Vertex place = place_of(element, surface);
      return { { "", element.fault },
               { "", element.is_face ? "face" : "vertex" },
               { "", fmt::format("{}", element.index + 1) },
               { "", fmt::format("{}", element.index) },
               { "", shortest_text(place[0]) },
               { "", shortest_text(place[1]) },
               { "", shortest_text(place[2]) } };
    }
  } // namespace

  std::string
  table_of_faults(const std::filesystem::path &file)
  {
    const auto check = [&]
    {
      confine_this_process({ file });
      const SurfaceMesh surface = read_surface(file);
      CheckedSurface    checked;
      checked.surface = triangulate(surface, &checked.faces);
      std::ostringstream table;
      table << header_of_faults;
      std::set<std::tuple<std::string, bool, unsigned int>> written;
      for (const FaultyElement &element : check_surface(checked).elements)
        if (written.emplace(element.fault, element.is_face, element.index).second)
          write_csv_cells(table, row_of(element, surface));
      return table.str();
    };
    return in_process_copy(check, { file.string() + ": checking the surface",
                                    "Simplify it in the program that made it.", max_seconds });
  }
} // namespace Exemplar
