// SPDX-License-Identifier: GPL-3.0-or-later
// Format: 3D Systems, "StereoLithography Interface Specification" (1989).
#include <exemplar/base/message_text.h>
#include <exemplar/surface/files/surface_formats.h>
#include <exemplar/surface/files/surface_scanner.h>

#include <fmt/core.h>

#include <cstring>
#include <unordered_map>

namespace Exemplar
{
  namespace
  {
    using Vertex = SurfaceMesh::Vertex;

    struct VertexHash
    {
      std::size_t
      operator()(const Vertex &vertex) const
      {
        std::size_t hash = 0;
        for (const double x : vertex)
          hash = 31 * hash + std::hash<double>()(x);
        return hash;
      }
    };

    /// Joins corners of the same coordinates; 0 and -0 are the same.
    class Corners
    {
    public:
      explicit Corners(SurfaceMesh &mesh) : surface(mesh) {}

      unsigned int
      vertex_at(const Vertex &place)
      {
        const auto found
            = index_of.emplace(place, static_cast<unsigned int>(surface.vertices.size()));
        if (found.second)
          surface.vertices.push_back(place);
        return found.first->second;
      }

    private:
      SurfaceMesh                                         &surface;
      std::unordered_map<Vertex, unsigned int, VertexHash> index_of;
    };

    constexpr std::size_t header_size = 80, facet_size = 50;

    /// A binary file has a header of 80 bytes, the number of facets in 4 and 50 a facet. Headers
    /// may begin with "solid" as ASCII files do, so the size decides first.
    bool
    is_binary_stl(const std::string_view bytes)
    {
      if (bytes.size() >= header_size + 4)
      {
        std::uint32_t n = 0;
        std::memcpy(&n, bytes.data() + header_size, sizeof(n));
        if (bytes.size() == header_size + 4 + facet_size * static_cast<std::size_t>(n))
          return true;
      }
      const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
      if (begin == std::string_view::npos || bytes.compare(begin, 5, "solid") != 0)
        return true;
      return bytes.substr(0, 1024).find('\0') != std::string_view::npos;
    }

    SurfaceMesh
    read_binary_stl(SurfaceScanner &in)
    {
      if (in.all().size() < header_size + 4)
        in.fail("neither begins with \"solid\", as an ASCII .stl file does, nor has the 84 bytes "
                "that a binary one begins with. Export the surface anew.");
      in.begin_binary(false);
      in.go_to(header_size);
      const auto  n = in.raw<std::uint32_t>();
      SurfaceMesh surface;
      Corners     corners(surface);
      in.begin_count(n, "facets");
      for (std::uint32_t f = 0; f < n; ++f, in.count())
      {
        for (unsigned int i = 0; i < 3; ++i)
          in.raw<float>(); // the normal; the order of corners gives it better
        std::vector<unsigned int> face(3);
        for (unsigned int &vertex : face)
        {
          Vertex place;
          for (double &x : place)
            x = static_cast<double>(in.raw<float>());
          vertex = corners.vertex_at(place);
        }
        in.raw<std::uint16_t>();
        surface.faces.push_back(std::move(face));
      }
      if (in.n_bytes_left() > 0)
        in.fail(fmt::format(
            "{} bytes follow the {} facets that the file announces. Export the surface anew.",
            in.n_bytes_left(), n));
      return surface;
    }

    /// ASCII: the lines between "facet" and "endfacet" are read for their "vertex".
    class AsciiStlReader
    {
    public:
      explicit AsciiStlReader(SurfaceScanner &scanner)
          : in(scanner), corners(surface), faces(surface)
      {
      }

      SurfaceMesh
      read()
      {
        while (in.next_line())
          read_line(in.words()[0]);
        if (within_facet || within_solid)
          in.fail("the file ends within a solid; it is truncated. Save or copy it anew.");
        faces.finish();
        return std::move(surface);
      }

    private:
      void
      read_line(const std::string_view keyword)
      {
        if (keyword == "vertex" && within_facet)
          read_vertex();
        else if (keyword == "facet" && within_solid && !within_facet)
          within_facet = true;
        else if (keyword == "endfacet" && within_facet)
          end_facet();
        else if (keyword == "solid" && !within_solid)
        {
          within_solid = true;
          name         = in.rest_of_line(1);
        }
        else if (keyword == "endsolid" && within_solid && !within_facet)
          within_solid = false;
        else if (!within_facet || (keyword != "outer" && keyword != "endloop"))
          in.fail(in_quotes(keyword)
                  + " is not what an .stl file has here (solid, facet, outer loop, three times "
                    "vertex, endloop, endfacet, endsolid). Export the surface anew.");
      }

      void
      read_vertex()
      {
        if (in.words().size() != 4)
          in.fail(fmt::format("a vertex has three coordinates, found {}. Export the surface anew.",
                              in.words().size() - 1));
        facet.push_back(corners.vertex_at({ { in.number(1), in.number(2), in.number(3) } }));
      }

      void
      end_facet()
      {
        if (facet.size() != 3)
          in.fail(fmt::format("a facet has three vertices, found {}. Export the surface anew.",
                              facet.size()));
        faces.add(std::move(facet), name);
        facet        = {};
        within_facet = false;
      }

      SurfaceScanner           &in;
      SurfaceMesh               surface;
      Corners                   corners;
      GroupedFaces              faces;
      std::string               name;
      std::vector<unsigned int> facet;
      bool                      within_solid = false;
      bool                      within_facet = false;
    };
  } // namespace

  SurfaceMesh
  read_stl(SurfaceScanner &in)
  {
    return is_binary_stl(in.all()) ? read_binary_stl(in) : AsciiStlReader(in).read();
  }
} // namespace Exemplar
