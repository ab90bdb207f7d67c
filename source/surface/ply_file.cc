// SPDX-License-Identifier: GPL-3.0-or-later
// Format: G. Turk, "The PLY Polygon File Format" (1994).
#include <exemplar/base/message_text.h>
#include <exemplar/surface/surface_formats.h>
#include <exemplar/surface/surface_scanner.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace Exemplar
{
  namespace
  {
    enum class PlyType
    {
      int8,
      uint8,
      int16,
      uint16,
      int32,
      uint32,
      float32,
      float64
    };

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

    struct PlyProperty
    {
      std::string            name;
      PlyType                type;
      std::optional<PlyType> count; ///< of a list: the type of its length
    };

    struct PlyElement
    {
      std::string              name;
      std::size_t              n;
      std::vector<PlyProperty> properties;

      /// The first property of one of these names, lists or not; their number if there is none.
      template <typename Names>
      std::size_t
      find(const Names &names, const bool list) const
      {
        for (const std::string_view name : names)
          for (std::size_t p = 0; p < properties.size(); ++p)
            if (properties[p].name == name && properties[p].count.has_value() == list)
              return p;
        return properties.size();
      }
    };

    /// What programs call the part that a face belongs to.
    constexpr std::array<std::string_view, 15> label_names{
      { "label", "labels", "group", "group_id", "region", "boundary_id", "material_index",
        "material", "material_id", "object_id", "segment", "part", "category_id", "patch",
        "face_label" }
    };

    class PlyReader
    {
    public:
      explicit PlyReader(SurfaceScanner &scanner) : in(scanner), faces(surface) {}

      SurfaceMesh
      read();

    private:
      void
      read_header();
      void
      read_format();
      void
      add_element();
      void
      add_property();
      void
      read_element(const PlyElement &element);
      /// The values of an element: one vector a property.
      void
      read_values(const PlyElement &element);
      double
      next_value(PlyType type);
      std::size_t
      list_length(double value, const PlyProperty &property) const;
      void
      add_vertex(const std::array<std::size_t, 3> &coordinates);
      void
      add_face(std::size_t corners, std::size_t label, std::size_t n_properties);
      void
      check_indices() const;

      SurfaceScanner                  &in;
      SurfaceMesh                      surface;
      GroupedFaces                     faces;
      std::vector<PlyElement>          elements;
      bool                             ascii = true;
      std::size_t                      word  = 0; ///< of the line, to be read next
      std::vector<std::vector<double>> values;
    };

    SurfaceMesh
    PlyReader::read()
    {
      read_header();
      for (const PlyElement &element : elements)
        read_element(element);
      check_indices();
      faces.finish();
      return std::move(surface);
    }

    void
    PlyReader::read_header()
    {
      if (!in.next_line() || in.words()[0] != "ply")
        in.fail("a .ply file begins with a line that says ply. Export the surface anew.");
      bool swapped = false;
      while (in.next_line())
      {
        const std::string_view keyword = in.words()[0];
        if (keyword == "end_header")
          break;
        if (keyword == "format")
        {
          read_format();
          swapped = in.words()[1] == "binary_big_endian";
        }
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
      if (!ascii)
        in.begin_binary(swapped);
    }

    void
    PlyReader::read_format()
    {
      const std::string_view format = in.words().size() > 1 ? in.words()[1] : std::string_view();
      if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
        in.fail("the format must be ascii, binary_little_endian or binary_big_endian, found "
                + in_quotes(format) + ". Export the surface anew.");
      ascii = format == "ascii";
    }

    void
    PlyReader::add_element()
    {
      if (in.words().size() != 3)
        in.fail("an element is announced as: element NAME NUMBER. Export the surface anew.");
      const long long n = in.integer(in.words()[2]);
      if (n < 0)
        in.fail("a number of elements cannot be negative, found " + std::to_string(n)
                + ". Export the surface anew.");
      require_few(in, static_cast<std::size_t>(n), "elements");
      elements.push_back({ std::string(in.words()[1]), static_cast<std::size_t>(n), {} });
    }

    void
    PlyReader::add_property()
    {
      const auto &words = in.words();
      const bool  list  = words.size() == 5 && words[1] == "list";
      if ((!list && words.size() != 3) || elements.empty())
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
      elements.back().properties.push_back({ std::string(words.back()), *type, count });
    }

    void
    PlyReader::read_element(const PlyElement &element)
    {
      using Names                     = std::vector<std::string_view>;
      const std::size_t          none = element.properties.size();
      std::array<std::size_t, 3> coordinates{ { none, none, none } };
      std::size_t                corners = none, label = none;
      if (element.name == "vertex")
      {
        coordinates = { { element.find(Names{ "x" }, false), element.find(Names{ "y" }, false),
                          element.find(Names{ "z" }, false) } };
        if (*std::max_element(coordinates.begin(), coordinates.end()) == none)
          in.fail("the vertices have no properties x, y and z. Export the surface anew.");
      }
      else if (element.name == "face")
      {
        corners = element.find(Names{ "vertex_indices", "vertex_index" }, true);
        label   = element.find(label_names, false);
        if (corners == none)
          in.fail("the faces have no list vertex_indices. Export the surface anew.");
      }
      else if (element.name == "tristrips")
        in.fail("strips of triangles are not supported. Export the surface as faces.");
      in.begin_count(element.n, "elements of " + in_quotes(element.name));
      for (std::size_t i = 0; i < element.n; ++i, in.count())
      {
        read_values(element);
        if (element.name == "vertex")
          add_vertex(coordinates);
        else if (corners < none)
          add_face(corners, label, none);
      }
    }

    void
    PlyReader::read_values(const PlyElement &element)
    {
      if (ascii && !element.properties.empty())
      {
        if (!in.next_line())
          in.fail_at_end();
        word = 0;
      }
      values.resize(std::max(values.size(), element.properties.size()));
      for (std::size_t p = 0; p < element.properties.size(); ++p)
      {
        const PlyProperty &property = element.properties[p];
        values[p].clear();
        const std::size_t n
            = property.count ? list_length(next_value(*property.count), property) : 1;
        for (std::size_t k = 0; k < n; ++k)
          values[p].push_back(next_value(property.type));
      }
      if (ascii && !element.properties.empty() && word != in.words().size())
        in.fail("an element of " + in_quotes(element.name) + " has " + std::to_string(word)
                + " numbers by the header, found " + std::to_string(in.words().size())
                + ". Export the surface anew.");
    }

    double
    PlyReader::next_value(const PlyType type)
    {
      if (ascii)
      {
        if (word == in.words().size())
          in.fail("the line ends after " + std::to_string(word)
                  + " numbers, but by the header there are more. Export the surface anew.");
        return in.number(word++);
      }
      switch (type)
      {
      case PlyType::int8:
        return in.raw<std::int8_t>();
      case PlyType::uint8:
        return in.raw<std::uint8_t>();
      case PlyType::int16:
        return in.raw<std::int16_t>();
      case PlyType::uint16:
        return in.raw<std::uint16_t>();
      case PlyType::int32:
        return in.raw<std::int32_t>();
      case PlyType::uint32:
        return in.raw<std::uint32_t>();
      case PlyType::float32:
        return static_cast<double>(in.raw<float>());
      default:
        return in.raw<double>();
      }
    }

    std::size_t
    PlyReader::list_length(const double value, const PlyProperty &property) const
    {
      const std::size_t left = ascii ? in.words().size() : in.n_bytes_left();
      if (!(value >= 0.) || value != std::floor(value))
        in.fail("the list " + in_quotes(property.name)
                + " has a length that is no count. Export the surface anew.");
      if (value > static_cast<double>(left))
      {
        if (!ascii)
          in.fail_at_end();
        in.fail("the list " + in_quotes(property.name)
                + " announces more numbers than its line has. Export the surface anew.");
      }
      return static_cast<std::size_t>(value);
    }

    void
    PlyReader::add_vertex(const std::array<std::size_t, 3> &coordinates)
    {
      surface.vertices.push_back(
          { { values[coordinates[0]][0], values[coordinates[1]][0], values[coordinates[2]][0] } });
    }

    void
    PlyReader::add_face(const std::size_t corners,
                        const std::size_t label,
                        const std::size_t n_properties)
    {
      std::vector<unsigned int> face;
      if (values[corners].size() < 3)
        in.fail("face " + std::to_string(surface.faces.size() + 1) + " has "
                + std::to_string(values[corners].size())
                + " vertices, at least three are needed. Delete it, or export the surface anew.");
      for (const double vertex : values[corners])
      {
        if (!(vertex >= 0. && vertex < 4e9) || vertex != std::floor(vertex))
          in.fail("face " + std::to_string(surface.faces.size() + 1)
                  + " uses a vertex whose number is no count from 0. Export the surface anew.");
        face.push_back(static_cast<unsigned int>(vertex));
      }
      const bool has_label = label < n_properties;
      if (has_label && !(std::abs(values[label][0]) <= 1e15))
        in.fail("the label of face " + std::to_string(surface.faces.size() + 1)
                + " is no number. Export the surface anew.");
      faces.add(std::move(face),
                has_label ? std::to_string(static_cast<long long>(values[label][0])) : "");
    }

    void
    PlyReader::check_indices() const
    {
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (const unsigned int vertex : surface.faces[f])
          if (vertex >= surface.vertices.size())
            in.fail(
                "face " + std::to_string(f + 1) + " of " + std::to_string(surface.faces.size())
                + " uses vertex " + std::to_string(vertex) + " (counted from 0), but the file has "
                + std::to_string(surface.vertices.size()) + " vertices. Export the surface anew.");
    }
  } // namespace

  SurfaceMesh
  read_ply(SurfaceScanner &in)
  {
    return PlyReader(in).read();
  }
} // namespace Exemplar
