// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/csv_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/base/number_text.h>
#include <exemplar/surface/files/painted_map.h>
#include <exemplar/surface/files/surface_formats.h>
#include <exemplar/surface/files/surface_scanner.h>
#include <exemplar/surface/shape/vectors.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    using Cells = std::vector<std::string>;

    const char *const table_remedy
        = " Write a line 'vertex,NAME' and then, for each vertex, its number from 1 and its value.";

    /// Reads a table of values of vertices.
    class TableReader
    {
    public:
      TableReader(const std::filesystem::path &file,
                  const std::string           &column,
                  const std::size_t            n_vertices,
                  const std::string           &surface_name)
          : name(file.string()), column(column), surface_name(surface_name),
            values(n_vertices, std::nan(""))
      {
        for (const CsvLine &each : read_csv_file(file, "map"))
        {
          line = each.number;
          read_line(each.cells);
        }
        if (n_rows == 0)
          throw UserError(name + ": the map has no values." + table_remedy);
        if (vertex_column == none && n_rows != n_vertices)
          throw UserError(fmt::format("{}: has {} rows of values, but {} has {} vertices.{}", name,
                                      n_rows, surface_name, n_vertices, table_remedy));
      }

      std::vector<double> &
      get_values()
      {
        return values;
      }

    private:
      [[noreturn]] void
      fail(const std::string &message) const
      {
        throw UserError(fmt::format("{}, line {}: {}", name, line, message));
      }

      void
      read_line(const Cells &cells)
      {
        if (width == 0)
        {
          width                = cells.size();
          const bool has_names = !std::all_of(cells.begin(), cells.end(), is_number);
          find_columns(has_names ? cells : Cells());
          if (has_names)
            return;
        }
        if (cells.size() != width)
          fail(fmt::format("has {} cells, the line before {}.{}", cells.size(), width,
                           table_remedy));
        const std::size_t vertex = vertex_column == none ? n_rows : vertex_of(cells[vertex_column]);
        const std::string &cell  = cells[value_column];
        if (!is_number(cell) || !std::isfinite(parse_number(cell)))
          fail(in_quotes(cell) + " is no finite number." + table_remedy);
        if (vertex < values.size())
        {
          if (!std::isnan(values[vertex]))
            fail(fmt::format("vertex {} has a value already. Keep one.", vertex + 1));
          values[vertex] = parse_number(cell);
        }
        ++n_rows;
      }

      std::size_t
      vertex_of(const std::string &cell) const
      {
        const double number = is_number(cell) ? parse_number(cell) : 0.;
        if (!(number >= 1. && number <= static_cast<double>(values.size()))
            || number != std::floor(number))
          fail(fmt::format("{} is no vertex of {}, whose {} vertices are counted from 1.",
                           in_quotes(cell), surface_name, values.size()));
        return static_cast<std::size_t>(number) - 1;
      }

      void
      find_columns(const Cells &names)
      {
        const auto index = [&](const std::string &wanted)
        {
          const auto found = std::find(names.begin(), names.end(), wanted);
          return found == names.end() ? none : static_cast<std::size_t>(found - names.begin());
        };
        vertex_column = names.empty() ? (width == 2 ? 0 : none) : index("vertex");
        if (!column.empty())
        {
          value_column = index(column);
          if (value_column == none)
            fail("there is no column " + in_quotes(column) + " (there: "
                 + (names.empty() ? "none: its first line names no columns"
                                  : printable(joined(names)))
                 + ")." + suggestion(names));
          return;
        }
        if (width != (vertex_column == none ? 1 : 2))
          fail("there are several columns of values. Say which one by FILE.csv:COLUMN, with a name "
               "of the first line.");
        value_column = vertex_column == 0 ? 1 : 0;
      }

      std::string
      suggestion(const Cells &names) const
      {
        const std::string nearest = nearest_word(column, names);
        return nearest.empty() ? " Write one of them behind the ':'."
                               : " Did you mean " + in_quotes(nearest) + "?";
      }

      static constexpr std::size_t none = static_cast<std::size_t>(-1);

      const std::string   name, column, surface_name;
      std::vector<double> values;
      std::size_t         line = 0, n_rows = 0, width = 0;
      std::size_t         vertex_column = none, value_column = none;
    };

    /// Refuses vertices whose distances to the next are not in proportion to those of the surface:
    /// distances do not depend on axes, and their ratio is that of the units.
    void
    check_same_vertices(const std::vector<SurfaceMesh::Vertex> &found,
                        const SurfaceMesh                      &surface,
                        const std::string                      &name,
                        const std::string                      &surface_name)
    {
      const auto &rest = surface.vertices;
      if (found.size() != rest.size())
        throw UserError(fmt::format("{}: has {} vertices, but {} has {}. Export both from the same "
                                    "model, in the same order.",
                                    name, found.size(), surface_name, rest.size()));
      const auto distances = [](const std::vector<SurfaceMesh::Vertex> &x)
      {
        std::vector<double> result;
        for (std::size_t v = 0; v + 1 < x.size(); ++v)
          result.push_back(norm(minus(x[v + 1], x[v])));
        return result;
      };
      const auto ours = distances(found), theirs = distances(rest);
      double     sum = 0., rest_sum = 0.;
      for (std::size_t v = 0; v < ours.size(); ++v)
      {
        sum += ours[v];
        rest_sum += theirs[v];
      }
      const double ratio = sum / rest_sum, mean = sum / static_cast<double>(ours.size());
      for (std::size_t v = 0; v < ours.size(); ++v)
        if (!(std::abs(ours[v] - ratio * theirs[v]) <= 1e-3 * mean + 1e-2 * ours[v]))
          throw UserError(
              fmt::format("{}: vertices {} and {} are not those of {}: their distance is another "
                          "one. Export both from the same model, at rest and in the same order.",
                          name, v + 1, v + 2, surface_name));
    }

    std::vector<double>
    read_ply_map(const std::filesystem::path &file,
                 const std::string           &attribute,
                 const SurfaceMesh           &surface,
                 const std::string           &surface_name)
    {
      SurfaceScanner     in(file);
      const PlyAttribute found = read_ply_attribute(in, attribute);
      check_same_vertices(found.vertices, surface, file.string(), surface_name);
      for (std::size_t v = 0; v < found.values.size(); ++v)
        if (!std::isfinite(found.values[v]))
          throw UserError(fmt::format(
              "{}: {} of vertex {} is no finite number. Paint it anew, or correct the file.",
              file.string(), in_quotes(attribute), v + 1));
      return found.values;
    }
  } // namespace

  std::vector<double>
  read_painted_map(const std::filesystem::path &file,
                   const std::string           &attribute,
                   const SurfaceMesh           &surface,
                   const std::string           &surface_name)
  {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".ply")
      return read_ply_map(file, attribute, surface, surface_name);
    return TableReader(file, attribute, surface.vertices.size(), surface_name).get_values();
  }
} // namespace Exemplar
