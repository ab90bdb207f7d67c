// SPDX-License-Identifier: GPL-3.0-or-later
// Format: G. Turk, "The PLY Polygon File Format" (1994).
#include <exemplar/base/message_text.h>
#include <exemplar/surface/files/ply_header.h>
#include <exemplar/surface/files/surface_formats.h>
#include <exemplar/surface/files/surface_scanner.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Names that programs use for the part that a face belongs to.
    constexpr std::array<std::string_view, 15> label_names{
      { "label", "labels", "group", "group_id", "region", "boundary_id", "material_index",
        "material", "material_id", "object_id", "segment", "part", "category_id", "patch",
        "face_label" }
    };

    /// Factor of the values of a type: 1/255 for one byte, as colours have, else 1.
    double
    unit_of(const PlyType type)
    {
      return type == PlyType::uint8 ? 1. / 255. : 1.;
    }

    class PlyReader
    {
    public:
      explicit PlyReader(SurfaceScanner &scanner) : in(scanner), faces(surface) {}

      SurfaceMesh
      read();

      /// Reads the surface and the values of a property of its vertices.
      PlyAttribute
      read_with(const std::string &name);

    private:
      std::size_t
      find_attribute(const PlyElement &element) const;
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
      add_texture_point(double u, double v);
      void
      add_texture_of_face(const std::vector<double> &coordinates);
      void
      check_indices() const;

      SurfaceScanner                  &in;
      SurfaceMesh                      surface;
      GroupedFaces                     faces;
      bool                             ascii = true;
      std::size_t                      word  = 0; ///< next word of the line
      std::vector<std::vector<double>> values;
      bool                             wants_attribute = false;
      std::string                      attribute;
      std::vector<double>              attributes;
    };

    PlyAttribute
    PlyReader::read_with(const std::string &name)
    {
      wants_attribute   = true;
      attribute         = name;
      SurfaceMesh whole = read();
      return { std::move(whole.vertices), std::move(attributes) };
    }

    std::size_t
    PlyReader::find_attribute(const PlyElement &element) const
    {
      const std::size_t found
          = element.find(std::array<std::string_view, 1>{ { attribute } }, false);
      if (found < element.properties.size())
        return found;
      std::string names;
      for (const PlyProperty &property : element.properties)
        if (!property.count)
          names += (names.empty() ? "" : ", ") + property.name;
      in.fail((attribute.empty() ? "say which attribute of the vertices, by FILE.ply:ATTRIBUTE"
                                 : "the vertices have no attribute " + in_quotes(attribute))
              + " (there: " + names + ").");
    }

    SurfaceMesh
    PlyReader::read()
    {
      const PlyHeader header = read_ply_header(in);
      ascii                  = header.ascii;
      if (!ascii)
        in.begin_binary(header.swapped);
      for (const PlyElement &element : header.elements)
        read_element(element);
      check_indices();
      faces.finish();
      if (surface.texture_points.size() == surface.vertices.size()
          && surface.face_texture_points.empty())
        surface.face_texture_points = surface.faces; // a texture point a vertex
      if (surface.face_texture_points.size() != surface.faces.size())
      {
        surface.texture_points.clear();
        surface.face_texture_points.clear();
      }
      return std::move(surface);
    }

    void
    PlyReader::read_element(const PlyElement &element)
    {
      using Names                     = std::vector<std::string_view>;
      const std::size_t          none = element.properties.size();
      std::array<std::size_t, 3> coordinates{ { none, none, none } };
      std::size_t                corners = none, label = none, wanted = none, texture = none;
      std::array<std::size_t, 2> texture_of_vertex{ { none, none } };
      if (element.name == "vertex")
      {
        coordinates = { { element.find(Names{ "x" }, false), element.find(Names{ "y" }, false),
                          element.find(Names{ "z" }, false) } };
        if (*std::max_element(coordinates.begin(), coordinates.end()) == none)
          in.fail("the vertices have no properties x, y and z. Export the surface anew.");
        texture_of_vertex
            = { { element.find(Names{ "s", "u", "texture_u", "texture_s" }, false),
                  element.find(Names{ "t", "v", "texture_v", "texture_t" }, false) } };
        if (wants_attribute)
          wanted = find_attribute(element);
      }
      else if (element.name == "face")
      {
        corners = element.find(Names{ "vertex_indices", "vertex_index" }, true);
        label   = element.find(label_names, false);
        texture = element.find(Names{ "texcoord" }, true);
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
        {
          add_vertex(coordinates);
          if (std::max(texture_of_vertex[0], texture_of_vertex[1]) < none)
            add_texture_point(values[texture_of_vertex[0]][0], values[texture_of_vertex[1]][0]);
          if (wanted < none)
            attributes.push_back(values[wanted][0] * unit_of(element.properties[wanted].type));
        }
        else if (corners < none)
        {
          add_face(corners, label, none);
          if (texture < none)
            add_texture_of_face(values[texture]);
        }
      }
    }

    void
    PlyReader::add_texture_point(const double u, const double v)
    {
      surface.texture_points.push_back(
          { { std::isfinite(u) ? u : 0., std::isfinite(v) ? v : 0. } });
    }

    /// Texture points of a face's corners, two numbers each; none from a list of another length.
    void
    PlyReader::add_texture_of_face(const std::vector<double> &coordinates)
    {
      std::vector<unsigned int> points;
      if (coordinates.size() == 2 * surface.faces.back().size())
        for (std::size_t i = 0; i < coordinates.size(); i += 2)
        {
          points.push_back(static_cast<unsigned int>(surface.texture_points.size()));
          add_texture_point(coordinates[i], coordinates[i + 1]);
        }
      surface.face_texture_points.push_back(std::move(points));
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
        in.fail(fmt::format(
            "an element of {} has {} numbers by the header, found {}. Export the surface anew.",
            in_quotes(element.name), word, in.words().size()));
    }

    double
    PlyReader::next_value(const PlyType type)
    {
      if (ascii)
      {
        if (word == in.words().size())
          in.fail(fmt::format("the line ends after {} numbers, but by the header there are more. "
                              "Export the surface anew.",
                              word));
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
        in.fail(fmt::format("face {} has {} vertices, at least three are needed. Delete it, or "
                            "export the surface anew.",
                            surface.faces.size() + 1, values[corners].size()));
      for (const double vertex : values[corners])
      {
        if (!(vertex >= 0. && vertex < 4e9) || vertex != std::floor(vertex))
          in.fail(fmt::format(
              "face {} uses a vertex whose number is no count from 0. Export the surface anew.",
              surface.faces.size() + 1));
        face.push_back(static_cast<unsigned int>(vertex));
      }
      const bool has_label = label < n_properties;
      if (has_label && !(std::abs(values[label][0]) <= 1e15))
        in.fail(fmt::format("the label of face {} is no number. Export the surface anew.",
                            surface.faces.size() + 1));
      faces.add(std::move(face),
                has_label ? fmt::format("{}", static_cast<long long>(values[label][0])) : "");
    }

    void
    PlyReader::check_indices() const
    {
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (const unsigned int vertex : surface.faces[f])
          if (vertex >= surface.vertices.size())
            in.fail(fmt::format("face {} of {} uses vertex {} (counted from 0), but the file has "
                                "{} vertices. Export the surface anew.",
                                f + 1, surface.faces.size(), vertex, surface.vertices.size()));
    }
  } // namespace

  SurfaceMesh
  read_ply(SurfaceScanner &in)
  {
    return PlyReader(in).read();
  }

  PlyAttribute
  read_ply_attribute(SurfaceScanner &in, const std::string &name)
  {
    return PlyReader(in).read_with(name);
  }
} // namespace Exemplar
