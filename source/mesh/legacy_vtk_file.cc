// SPDX-License-Identifier: GPL-3.0-or-later
// Format: VTK User's Guide, "VTK File Formats", and VTK's documentation of version 5.1.
#include <exemplar/mesh/format_readers.h>
#include <exemplar/mesh/mesh_text.h>
#include <exemplar/mesh/vtk_grid.h>

#include <fmt/core.h>

#include <cctype>
#include <cmath>
#include <map>

namespace Exemplar
{
  namespace
  {
    class LegacyVtkReader
    {
    public:
      LegacyVtkReader(std::string bytes, const std::string &name) : text(std::move(bytes), name) {}

      MshFile
      read()
      {
        read_head();
        while (!text.at_end())
          read_section(in_capitals(text.word("a section")));
        for (const auto &[values, name] :
             { std::pair(&grid.points, "POINTS"), std::pair(&grid.offsets, "CELLS"),
               std::pair(&grid.types, "CELL_TYPES") })
          if (values->empty())
            text.fail_at_end(std::string("the section ") + name);
        return msh_of_grid(grid, text.get_name());
      }

    private:
      void
      read_head()
      {
        const std::string begin = "# vtk DataFile Version ";
        const std::string first(text.rest_of_line());
        if (first.rfind(begin, 0) != 0)
          text.fail("a legacy VTK file begins with '" + begin
                    + "', this one does not. VTK's files in XML end in .vtu.");
        version = text.number_of(words_of(first.substr(begin.size()) + " 0")[0], "the version");
        if (!(version >= 1. && version < 6.))
          text.fail(
              fmt::format("version {} is not known (1 to 5.1 are). Save the mesh as version 4.2 "
                          "or 5.1.",
                          version));
        text.rest_of_line(); // the title
        const std::string form = in_capitals(text.word("ASCII or BINARY"));
        if (form != "ASCII" && form != "BINARY")
          text.fail("the third line should be ASCII or BINARY. Save or copy the mesh again.");
        is_binary = form == "BINARY";
        if (in_capitals(text.word("DATASET")) != "DATASET")
          text.fail("the fourth line should be DATASET UNSTRUCTURED_GRID. Save the mesh anew.");
        if (const std::string kind = in_capitals(text.word("a kind of data set"));
            kind != "UNSTRUCTURED_GRID")
          text.fail(
              "the data set is " + kind.substr(0, 40)
              + ", which has no tetrahedra; UNSTRUCTURED_GRID is read. In ParaView: Filters > "
                "Tetrahedralize, File > Save Data as .vtu.");
      }

      void
      read_section(const std::string &name)
      {
        if (name == "POINTS")
          read_points();
        else if (name == "CELLS")
          read_cells();
        else if (name == "CELL_TYPES")
          set(grid.types, name, values(text.count("the number of types"), "int", "CELL_TYPES"));
        else if (name == "CELL_DATA" || name == "POINT_DATA")
        {
          is_of_cells = name == "CELL_DATA";
          n_items     = text.size("the number behind " + name);
        }
        else if (name == "FIELD")
          read_field();
        else if (name == "METADATA")
          pass_metadata();
        else if (name == "LOOKUP_TABLE")
          pass_lookup_table();
        else
          read_attribute(name);
      }

      /// Behind the word METADATA: VTK and ParaView describe the array before in a block that ends with an empty line.
      void
      pass_metadata()
      {
        text.rest_of_line();
        while (text.n_bytes_left() > 0 && !words_of(text.rest_of_line()).empty())
        {
        }
      }

      /// Colours: four numbers from 0 to 1 each, or four bytes.
      void
      pass_lookup_table()
      {
        text.word("the name of a lookup table");
        const std::size_t n = text.count("the size of a lookup table");
        values(checked_product(4, n), is_binary ? "unsigned_char" : "float", "colours");
      }

      /// Each section is there once.
      void
      set(std::vector<double> &target, const std::string &name, std::vector<double> values)
      {
        if (!target.empty())
          text.fail("the section " + name + " appears twice. Save the mesh anew.");
        target = std::move(values);
      }

      void
      read_points()
      {
        const std::size_t n    = text.count("the number of points");
        const std::string type = std::string(text.word("a type of numbers"));
        set(grid.points, "POINTS", values(3 * n, type, "coordinates"));
      }

      void
      read_cells()
      {
        const std::size_t n    = text.count("the number behind CELLS");
        const std::size_t size = text.count("the second number behind CELLS");
        text.rest_of_line();
        if (version >= 5.)
        {
          std::vector<double> ends = values_after("OFFSETS", n);
          if (ends.empty() || ends[0] != 0.)
            text.fail("OFFSETS should begin with 0. Save or copy the mesh again.");
          ends.erase(ends.begin());
          set(grid.offsets, "CELLS", std::move(ends));
          grid.connectivity = values_after("CONNECTIVITY", size);
          return;
        }
        const std::vector<double> all = values_here(size, "int", "entries of CELLS");
        std::vector<double>       ends;
        for (std::size_t at = 0; at < size;)
        {
          const double n_nodes = all[at++];
          if (!(n_nodes >= 1. && n_nodes <= static_cast<double>(size - at)))
            text.fail(
                fmt::format("cell {} (from 0) of CELLS should have {} nodes, but {} numbers are "
                            "left. Save or copy the mesh again.",
                            ends.size(), n_nodes, size - at));
          for (const std::size_t end = at + static_cast<std::size_t>(n_nodes); at < end; ++at)
            grid.connectivity.push_back(all[at]);
          ends.push_back(static_cast<double>(grid.connectivity.size()));
        }
        if (ends.size() != n)
          text.fail(
              fmt::format("CELLS announces {} cells, but has {}. Save or copy the mesh again.", n,
                          ends.size()));
        set(grid.offsets, "CELLS", std::move(ends));
      }

      std::vector<double>
      values_after(const std::string &keyword, const std::size_t n)
      {
        if (in_capitals(text.word(keyword)) != keyword)
          text.fail("CELLS of version 5 has OFFSETS and CONNECTIVITY; " + keyword
                    + " is not there. Save or copy the mesh again.");
        return values(n, std::string(text.word("a type of numbers")), "entries of " + keyword);
      }

      void
      read_field()
      {
        text.word("the name of a field");
        const std::size_t n = text.count("the number of arrays");
        for (std::size_t i = 0; i < n; ++i)
        {
          VtkArray array;
          array.name = std::string(text.word("the name of an array"));
          if (array.name == "METADATA") // belongs to the array before
          {
            pass_metadata();
            array.name = std::string(text.word("the name of an array"));
          }
          array.name                 = decoded(array.name);
          array.n_components         = text.count("the number of components");
          const std::size_t n_tuples = text.count("the number of entries");
          const std::string type     = std::string(text.word("a type of numbers"));
          if (type == "string")
          {
            text.rest_of_line();
            pass_strings(checked_product(array.n_components, n_tuples));
            continue;
          }
          if (type == "bit")
          {
            pass_bits(checked_product(array.n_components, n_tuples));
            continue;
          }
          array.values = values(checked_product(array.n_components, n_tuples), type,
                                "entries of " + array.name);
          add(std::move(array));
        }
      }

      /// A line of each in ASCII; else the length, of which the first two bits say in how many bytes it stands.
      void
      pass_strings(const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
        {
          if (!is_binary)
          {
            text.rest_of_line();
            continue;
          }
          const auto  byte   = [&] { return static_cast<unsigned char>(text.raw(1, "a text")[0]); };
          const auto  first  = byte();
          std::size_t length = first & 63U;
          for (unsigned int more = (1U << (3U - (first >> 6U))) - 1U; more > 0; --more)
            length = length << 8U | byte();
          text.raw(length, "the end of a text");
        }
      }

      void
      pass_bits(const std::size_t n)
      {
        text.rest_of_line();
        if (is_binary)
          text.raw((n + 7) / 8, "the end of an array of bits");
        else
          for (std::size_t i = 0; i < n; ++i)
            text.number("a bit");
      }

      /// A name in which VTK has written blanks and others as %20.
      static std::string
      decoded(const std::string &name)
      {
        std::string result;
        for (std::size_t i = 0; i < name.size(); ++i)
        {
          unsigned int code = 0;
          if (name[i] == '%' && i + 2 < name.size() && std::isxdigit(name[i + 1]) != 0
              && std::isxdigit(name[i + 2]) != 0)
          {
            code = static_cast<unsigned int>(std::stoul(name.substr(i + 1, 2), nullptr, 16));
            i += 2;
          }
          result += code > 0 ? static_cast<char>(code) : name[i];
        }
        return result;
      }

      std::size_t
      checked_product(const std::size_t a, const std::size_t b) const
      {
        if (a > 0 && b > text.n_bytes_left() / a)
          text.fail(
              fmt::format("{} times {} numbers are more than the file has. Save or copy the mesh "
                          "again.",
                          a, b));
        return a * b;
      }

      void
      add(VtkArray array)
      {
        if (is_of_cells && n_items > 0)
          grid.cell_arrays.push_back(std::move(array));
      }

      void
      read_attribute(const std::string &kind)
      {
        static const std::map<std::string, std::size_t> kinds{
          { "SCALARS", 1 },      { "VECTORS", 3 },      { "NORMALS", 3 },
          { "TENSORS", 9 },      { "TENSORS6", 6 },     { "TEXTURE_COORDINATES", 1 },
          { "GLOBAL_IDS", 1 },   { "PEDIGREE_IDS", 1 }, { "EDGE_FLAGS", 1 },
          { "COLOR_SCALARS", 1 }
        };
        const auto found = kinds.find(kind);
        if (found == kinds.end())
          text.fail(
              "'" + kind.substr(0, 40)
              + "' is no section that is read: these are POINTS, CELLS, CELL_TYPES, CELL_DATA and "
                "POINT_DATA with SCALARS, VECTORS, NORMALS, TENSORS and FIELD. Save the mesh "
                "without others.");
        VtkArray array;
        array.name         = decoded(std::string(text.word("the name of an array")));
        array.n_components = found->second;
        if (kind == "TEXTURE_COORDINATES" || kind == "COLOR_SCALARS")
          array.n_components = text.count("the number of components");
        const std::string type = kind != "COLOR_SCALARS"
                                     ? std::string(text.word("a type of numbers"))
                                 : is_binary ? "unsigned_char"
                                             : "float";
        const auto        more = words_of(text.rest_of_line());
        if (type == "string")
          return pass_strings(checked_product(array.n_components, n_items));
        if (kind == "SCALARS")
        {
          if (!more.empty())
            array.n_components
                = static_cast<std::size_t>(std::abs(text.integer_of(more[0], "components")));
          if (in_capitals(text.word("LOOKUP_TABLE")) != "LOOKUP_TABLE")
            text.fail("behind SCALARS a line LOOKUP_TABLE should follow. Save the mesh anew.");
          text.rest_of_line();
        }
        array.values = values_here(checked_product(array.n_components, n_items), type,
                                   "entries of " + array.name);
        add(std::move(array));
      }

      /// Numbers behind the end of this line.
      std::vector<double>
      values(const std::size_t n, const std::string &type, const std::string &what)
      {
        text.rest_of_line();
        return values_here(n, type, what);
      }

      std::vector<double>
      values_here(const std::size_t n, const std::string &type, const std::string &what)
      {
        const std::size_t size = size_of_vtk_type(type);
        if (size == 0)
          text.fail("numbers of the type '" + type.substr(0, 40) + "' are not read: save " + what
                    + " as double, float, int or long.");
        if (n > text.n_bytes_left())
          text.fail(
              fmt::format("{} {} are announced, but only {} bytes are left. The file is cut off, "
                          "or the number is wrong: save or copy the mesh again.",
                          n, what, text.n_bytes_left()));
        if (is_binary)
          return vtk_numbers(text.raw(n * size, fmt::format("the end of {} {}", n, what)), type,
                             true);
        std::vector<double> result;
        result.reserve(n);
        while (result.size() < n)
          result.push_back(
              text.number(fmt::format("number {} of {} {}", result.size() + 1, n, what)));
        return result;
      }

      MeshText    text;
      VtkGrid     grid;
      double      version     = 0.;
      bool        is_binary   = false;
      bool        is_of_cells = false;
      std::size_t n_items     = 0;
    };
  } // namespace

  MshFile
  read_legacy_vtk(std::string bytes, const std::string &name)
  {
    return LegacyVtkReader(std::move(bytes), name).read();
  }
} // namespace Exemplar
