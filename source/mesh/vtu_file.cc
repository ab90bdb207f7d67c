// SPDX-License-Identifier: GPL-3.0-or-later
// Format: https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/format_readers.h>
#include <exemplar/mesh/mesh_text.h>
#include <exemplar/mesh/vtk_grid.h>

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>

namespace Exemplar
{
  namespace
  {
    /// An element of XML without the elements within.
    struct XmlTag
    {
      std::string                        name;
      std::map<std::string, std::string> attributes;
      bool                               is_end    = false; ///< </name>
      bool                               is_single = false; ///< <name/>
    };

    /// Where the numbers of an array are, not yet decoded.
    struct VtuArray
    {
      std::string      name, type, form;
      std::size_t      n_components = 1, offset = 0;
      std::string_view content; ///< between the tags
    };

    /// Bytes of a text in base64; each part may end in = as if it were the last.
    std::string
    from_base64(const std::string_view text)
    {
      static const std::string digits
          = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      std::string  bytes;
      unsigned int group = 0, n_digits = 0, n_padding = 0;
      for (const char c : text)
      {
        const std::size_t digit = c == '=' ? 0 : digits.find(c);
        if (digit == std::string::npos)
        {
          if (std::string_view(" \t\r\n").find(c) != std::string_view::npos)
            continue;
          break; // the next array's, or the end
        }
        n_padding += c == '=' ? 1U : 0U;
        group = group << 6 | static_cast<unsigned int>(digit);
        if (++n_digits < 4)
          continue;
        for (unsigned int i = 0; i + std::min(n_padding, 2U) < 3; ++i)
          bytes += static_cast<char>(group >> (16 - 8 * i) & 255);
        group = n_digits = n_padding = 0;
      }
      return bytes;
    }

    class VtuReader
    {
    public:
      VtuReader(const std::string &bytes, const std::string &name) : all(bytes), name(name) {}

      MshFile
      read()
      {
        while (const auto tag = next_tag())
          visit(*tag);
        if (!has_grid)
          fail("there is no UnstructuredGrid, which alone has tetrahedra. In ParaView: Filters > "
               "Tetrahedralize, File > Save Data as .vtu.");
        if (!is_complete)
          fail("the file ends before </VTKFile>. It is cut off: save or copy the mesh again.");
        if (n_pieces != 1)
          fail(fmt::format(
              "there are {} pieces; a mesh is one. In ParaView: Filters > Merge Blocks, "
              "File > Save Data.",
              n_pieces));
        VtkGrid grid;
        grid.points       = numbers(array("Points", ""), 3 * n_points);
        grid.types        = numbers(array("Cells", "types"), n_cells);
        grid.offsets      = numbers(array("Cells", "offsets"), n_cells);
        const double n    = grid.offsets.empty() ? 0. : grid.offsets.back();
        grid.connectivity = numbers(array("Cells", "connectivity"), count_of(n, "the last offset"));
        for (const VtuArray &one : arrays["CellData"])
          if (one.n_components == 1)
            grid.cell_arrays.push_back({ one.name, 1, numbers(one, n_cells) });
        return msh_of_grid(grid, name);
      }

    private:
      [[noreturn]] void
      fail(const std::string &message) const
      {
        if (at == std::string_view::npos) // all tags are read
          throw UserError(name + ": " + message);
        const auto line
            = 1 + std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(at), '\n');
        throw UserError(fmt::format("{}: line {}: {}", name, line, message));
      }

      std::size_t
      count_of(const double n, const std::string &what) const
      {
        // deflate makes at most 1032 bytes of one
        if (!(n >= 0. && n <= 1032. * static_cast<double>(all.size())))
          fail(
              fmt::format("{} is {}, for which the file is too short. It is cut off, or the number "
                          "is wrong: save or copy the mesh again.",
                          what, n));
        return static_cast<std::size_t>(n);
      }

      std::size_t
      count_in(const XmlTag &tag, const std::string &attribute) const
      {
        const auto found = tag.attributes.find(attribute);
        if (found == tag.attributes.end())
          fail("<" + tag.name + "> has no " + attribute + ". Save or copy the mesh again.");
        const MeshText text("", name);
        return count_of(static_cast<double>(
                            text.integer_of(found->second, attribute + " of <" + tag.name + ">")),
                        attribute);
      }

      /// The next tag, past comments and declarations; none at the end.
      std::optional<XmlTag>
      next_tag()
      {
        for (;;)
        {
          at = all.find('<', at);
          if (at == std::string_view::npos)
            return {};
          const bool        is_comment = all.substr(at, 4) == "<!--";
          const std::string end        = is_comment ? "-->" : ">";
          const std::size_t last       = all.find(end, at);
          if (last == std::string_view::npos)
            fail("a tag has no end. The file is cut off: save or copy the mesh again.");
          const std::string_view inside = all.substr(at + 1, last - at - 1);
          at                            = last + end.size();
          if (!is_comment && !inside.empty() && inside[0] != '?' && inside[0] != '!')
            return tag_of(inside);
        }
      }

      XmlTag
      tag_of(std::string_view inside) const
      {
        XmlTag tag;
        tag.is_end    = inside[0] == '/';
        tag.is_single = inside.back() == '/';
        inside.remove_prefix(tag.is_end ? 1 : 0);
        inside.remove_suffix(tag.is_single && !inside.empty() ? 1 : 0);
        std::size_t i = std::min(inside.find_first_of(" \t\r\n"), inside.size());
        tag.name      = std::string(inside.substr(0, i));
        while ((i = inside.find_first_not_of(" \t\r\n", i)) < inside.size())
        {
          const std::size_t equals = inside.find('=', i);
          const std::size_t open
              = equals == inside.npos ? equals : inside.find_first_of("'\"", equals);
          const std::size_t close
              = open == inside.npos ? open : inside.find(inside[open], open + 1);
          if (close == inside.npos)
            fail("the attributes of <" + tag.name.substr(0, 40)
                 + "> are not NAME=\"VALUE\". Save or copy the mesh again.");
          const auto words = words_of(inside.substr(i, equals - i));
          if (words.size() != 1)
            fail("<" + tag.name.substr(0, 40)
                 + "> has an attribute without a name. Save or copy the "
                   "mesh again.");
          tag.attributes[std::string(words[0])]
              = std::string(inside.substr(open + 1, close - open - 1));
          i = close + 1;
        }
        return tag;
      }

      static bool
      is_section(const std::string &name)
      {
        return name == "Points" || name == "Cells" || name == "CellData" || name == "PointData"
               || name == "FieldData";
      }

      void
      visit(const XmlTag &tag)
      {
        if (tag.name == "VTKFile")
          tag.is_end ? void(is_complete = true) : read_form(tag);
        else if (tag.name == "UnstructuredGrid")
          has_grid = true;
        else if (tag.name == "Piece" && !tag.is_end)
        {
          ++n_pieces;
          n_points = count_in(tag, "NumberOfPoints");
          n_cells  = count_in(tag, "NumberOfCells");
        }
        else if (tag.name == "DataArray")
          tag.is_end ? void() : add_array(tag);
        else if (tag.name == "AppendedData" && !tag.is_end)
          skip_appended(tag);
        else if (!tag.is_single && is_section(tag.name)) // ParaView writes others within arrays
          section = tag.is_end ? "" : tag.name;
      }

      void
      read_form(const XmlTag &tag)
      {
        const auto value = [&](const std::string &attribute, const std::string &otherwise)
        {
          const auto found = tag.attributes.find(attribute);
          return found == tag.attributes.end() ? otherwise : found->second;
        };
        if (value("type", "") != "UnstructuredGrid")
          fail(
              "the file holds " + in_quotes(value("type", "").substr(0, 40))
              + "; an UnstructuredGrid is read, which alone has tetrahedra. In ParaView: Filters > "
                "Tetrahedralize, File > Save Data as .vtu.");
        is_big_endian = value("byte_order", "LittleEndian") == "BigEndian";
        header_type   = value("header_type", "UInt32");
        if (header_type != "UInt32" && header_type != "UInt64")
          fail("header_type is " + in_quotes(header_type.substr(0, 40))
               + "; UInt32 and UInt64 are read. Save the mesh anew.");
        const std::string compressor = value("compressor", "");
        is_compressed                = !compressor.empty();
        if (is_compressed && compressor != "vtkZLibDataCompressor")
          fail("the compressor is " + in_quotes(compressor.substr(0, 40))
               + "; vtkZLibDataCompressor is read, and files without one. In ParaView choose ZLib "
                 "in the options of File > Save Data.");
      }

      void
      add_array(const XmlTag &tag)
      {
        const auto value = [&](const std::string &attribute)
        {
          const auto found = tag.attributes.find(attribute);
          return found == tag.attributes.end() ? std::string() : found->second;
        };
        VtuArray one;
        one.name = value("Name");
        one.type = value("type");
        one.form = value("format");
        if (!value("NumberOfComponents").empty())
          one.n_components = count_in(tag, "NumberOfComponents");
        if (one.form == "appended")
          one.offset = count_in(tag, "offset");
        else if (!tag.is_single)
          one.content = all.substr(at, std::min(all.find('<', at), all.size()) - at);
        arrays[section].push_back(one);
      }

      void
      skip_appended(const XmlTag &tag)
      {
        const auto encoding     = tag.attributes.find("encoding");
        is_appended_in_base64   = encoding != tag.attributes.end() && encoding->second == "base64";
        const std::size_t begin = all.find('_', at), end = all.rfind("</AppendedData>");
        if (begin == all.npos || end == all.npos || end <= begin)
          fail("the appended data have no beginning _ or no end </AppendedData>. The file is cut "
               "off: save or copy the mesh again.");
        appended = all.substr(begin + 1, end - begin - 1);
        at       = end;
      }

      VtuArray
      array(const std::string &in_section, const std::string &wanted)
      {
        for (const VtuArray &one : arrays[in_section])
          if (wanted.empty() || one.name == wanted)
            return one;
        fail("<" + in_section + "> has no DataArray"
             + (wanted.empty() ? "" : " " + in_quotes(wanted)) + ". Save or copy the mesh again.");
      }

      std::vector<double>
      numbers(const VtuArray &one, const std::size_t n) const
      {
        const std::string what = "the array " + in_quotes(one.name);
        const std::size_t size = size_of_vtk_type(one.type);
        if (size == 0)
          fail(what + " has numbers of the type " + in_quotes(one.type.substr(0, 40))
               + "; Int8 to UInt64, Float32 and Float64 are read. Save the mesh anew.");
        std::vector<double> result;
        if (one.form == "ascii")
        {
          MeshText text{ std::string(one.content), name + ": " + what };
          while (!text.at_end())
            result.push_back(text.number("an entry"));
        }
        else if (one.form == "binary")
          result = vtk_numbers(data_of(from_base64(one.content), n * size, what), one.type,
                               is_big_endian);
        else if (one.form == "appended")
        {
          if (one.offset >= appended.size())
            fail(fmt::format(
                "{} begins at byte {} of the appended data, which have {}. Save or copy "
                "the mesh again.",
                what, one.offset, appended.size()));
          const std::string_view rest = appended.substr(one.offset);
          result
              = vtk_numbers(data_of(is_appended_in_base64 ? from_base64(rest) : std::string(rest),
                                    n * size, what),
                            one.type, is_big_endian);
        }
        else
          fail(what + " has the format " + in_quotes(one.form.substr(0, 40))
               + "; ascii, binary and appended are read. Save the mesh anew.");
        if (result.size() != n)
          fail(
              fmt::format("{} has {} numbers instead of {}. The file is cut off, or its counts are "
                          "wrong: save or copy the mesh again.",
                          what, result.size(), n));
        return result;
      }

      /// The data of an array behind its header, unpacked.
      std::string
      data_of(const std::string &block, const std::size_t n_bytes, const std::string &what) const
      {
        const std::size_t width  = header_type == "UInt64" ? 8 : 4;
        const auto        header = [&](const std::size_t i)
        {
          if (block.size() / width <= i)
            fail(what + " is cut off in its header. Save or copy the mesh again.");
          return vtk_numbers(std::string_view(block).substr(i * width, width), header_type,
                             is_big_endian)[0];
        };
        const auto require = [&](const double n)
        {
          if (n != static_cast<double>(n_bytes))
            fail(
                fmt::format("{} has {} bytes instead of {}. The file is cut off, or its counts are "
                            "wrong: save or copy the mesh again.",
                            what, n, n_bytes));
        };
        if (!is_compressed)
        {
          require(header(0));
          if (block.size() < width + n_bytes)
            fail(what + " is cut off. Save or copy the mesh again.");
          return block.substr(width, n_bytes);
        }
        const double n_blocks = header(0), full = header(1), last = header(2);
        if (!(n_blocks <= static_cast<double>(block.size())))
          fail(what + " has a wrong header. Save or copy the mesh again.");
        const auto n = static_cast<std::size_t>(n_blocks);
        require(n == 0 ? 0. : full * (n_blocks - (last > 0. ? 1. : 0.)) + last);
        std::string data(n_bytes, '\0');
        std::size_t from = (3 + n) * width, to = 0;
        for (std::size_t b = 0; b < n; ++b)
        {
          const double packed = header(3 + b);
          const auto   size   = static_cast<std::size_t>(b + 1 == n && last > 0. ? last : full);
          if (from > block.size() || !(packed <= static_cast<double>(block.size() - from)))
            fail(what + " is cut off. Save or copy the mesh again.");
          uLongf     unpacked = size;
          const auto status   = uncompress(reinterpret_cast<Bytef *>(&data[0]) + to, &unpacked,
                                           reinterpret_cast<const Bytef *>(block.data()) + from,
                                           static_cast<uLong>(packed));
          if (status != Z_OK || unpacked != size)
            fail(what + " cannot be unpacked. The file is damaged: save or copy the mesh again.");
          from += static_cast<std::size_t>(packed);
          to += size;
        }
        return data;
      }

      const std::string_view                       all;
      const std::string                            name;
      std::size_t                                  at = 0;
      std::string                                  section, header_type = "UInt32";
      std::map<std::string, std::vector<VtuArray>> arrays; ///< by the section that they stand in
      std::string_view                             appended;
      std::size_t                                  n_pieces = 0, n_points = 0, n_cells = 0;

      bool has_grid = false, is_complete = false, is_big_endian = false, is_compressed = false,
           is_appended_in_base64 = false;
    };
  } // namespace

  MshFile
  read_vtu(std::string bytes, const std::string &name)
  {
    if (bytes.find("<VTKFile") == std::string::npos)
      MeshText("", name).fail(
          "a .vtu begins with <VTKFile>, this file does not. VTK's older files end "
          "in .vtk.");
    return VtuReader(bytes, name).read();
  }
} // namespace Exemplar
