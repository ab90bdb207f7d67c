// SPDX-License-Identifier: GPL-3.0-or-later
// Format: G. Turk, "The PLY Polygon File Format" (1994).
#include <exemplar/base/message_text.h>
#include <exemplar/surface/files/ply_header.h>
#include <exemplar/surface/files/surface_formats.h>
#include <exemplar/surface/files/surface_scanner.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace Exemplar
{
  namespace
  {
    /// A type has two names.
    std::optional<PlyType>
    find_ply_type(const std::string_view name)
    {
      constexpr std::array<std::string_view, 16> names{
        { "char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int", "int32",
          "uint", "uint32", "float", "float32", "double", "float64" }
      };
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end())
        return {};
      return static_cast<PlyType>((found - names.begin()) / 2);
    }

    class PlyHeaderReader
    {
    public:
      explicit PlyHeaderReader(SurfaceScanner &scanner) : in(scanner) {}

      PlyHeader
      read();

    private:
      void
      read_format();
      void
      add_element();
      void
      add_property();

      SurfaceScanner &in;
      PlyHeader       header;
    };

    PlyHeader
    PlyHeaderReader::read()
    {
      if (!in.next_line() || in.words()[0] != "ply")
        in.fail("a .ply file begins with a line that says ply. Export the surface anew.");
      while (in.next_line())
      {
        const std::string_view keyword = in.words()[0];
        if (keyword == "end_header")
          break;
        if (keyword == "format")
          read_format();
        else if (keyword == "element")
          add_element();
        else if (keyword == "property")
          add_property();
        else if (keyword != "comment" && keyword != "obj_info")
          in.fail("expected format, element, property, comment or end_header, found "
                  + in_quotes(keyword) + ". Export the surface anew.");
      }
      if (in.words().empty())
        in.fail("the file ends within its header; it is truncated. Save or copy it anew.");
      return std::move(header);
    }

    void
    PlyHeaderReader::read_format()
    {
      const std::string_view format = in.words().size() > 1 ? in.words()[1] : std::string_view();
      if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
        in.fail("the format must be ascii, binary_little_endian or binary_big_endian, found "
                + in_quotes(format) + ". Export the surface anew.");
      header.ascii   = format == "ascii";
      header.swapped = format == "binary_big_endian";
    }

    void
    PlyHeaderReader::add_element()
    {
      if (in.words().size() != 3)
        in.fail("an element is announced as: element NAME NUMBER. Export the surface anew.");
      const long long n = in.integer(in.words()[2]);
      if (n < 0)
        in.fail(fmt::format(
            "a number of elements cannot be negative, found {}. Export the surface anew.", n));
      require_few(in, static_cast<std::size_t>(n), "elements");
      header.elements.push_back({ std::string(in.words()[1]), static_cast<std::size_t>(n), {} });
    }

    void
    PlyHeaderReader::add_property()
    {
      const auto &words = in.words();
      const bool  list  = words.size() == 5 && words[1] == "list";
      if ((!list && words.size() != 3) || header.elements.empty())
        in.fail("a property is announced, within an element, as: property TYPE NAME, or: property "
                "list TYPE TYPE NAME. Export the surface anew.");
      for (std::size_t i = list ? 2 : 1; i + 1 < words.size(); ++i)
        if (!find_ply_type(words[i]))
          in.fail("the type of a property must be char, uchar, short, ushort, int, uint, float or "
                  "double (or int8 to float64), found "
                  + in_quotes(words[i]) + ". Export the surface anew.");
      const auto type  = find_ply_type(words[words.size() - 2]);
      const auto count = list ? find_ply_type(words[2]) : std::nullopt;
      if (count && (*count == PlyType::float32 || *count == PlyType::float64))
        in.fail("the length of a list must be of an integer's type. Export the surface anew.");
      header.elements.back().properties.push_back({ std::string(words.back()), *type, count });
    }
  } // namespace

  PlyHeader
  read_ply_header(SurfaceScanner &in)
  {
    return PlyHeaderReader(in).read();
  }
} // namespace Exemplar
