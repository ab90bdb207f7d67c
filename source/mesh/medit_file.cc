// SPDX-License-Identifier: GPL-3.0-or-later
// Format: P. Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253 (2001), and
// libMeshb's documentation.
#include <exemplar/base/errors.h>
#include <exemplar/mesh/format_readers.h>
#include <exemplar/mesh/mesh_builder.h>
#include <exemplar/mesh/mesh_text.h>

#include <fmt/core.h>

#include <array>

namespace Exemplar
{
  namespace
  {
    struct MeditElement
    {
      const char  *keyword;
      unsigned int type; ///< gmsh's
    };

    constexpr MeditElement medit_elements[] = {
      { "Edges", MshElementType::line },
      { "EdgesP2", MshElementType::quadratic_line },
      { "Triangles", MshElementType::triangle },
      { "TrianglesP2", MshElementType::quadratic_triangle },
      { "Quadrilaterals", 3 },
      { "Tetrahedra", MshElementType::tetrahedron },
      { "TetrahedraP2", MshElementType::quadratic_tetrahedron },
      { "Hexahedra", 5 },
      { "Prisms", 6 },
      { "Pyramids", 7 },
    };

    /// Words of an entry of sections that are passed over.
    struct PassedSection
    {
      const char *keyword;
      std::size_t n_words;
    };

    constexpr PassedSection passed_sections[] = {
      { "Corners", 1 },
      { "RequiredVertices", 1 },
      { "Ridges", 1 },
      { "RequiredEdges", 1 },
      { "RequiredTriangles", 1 },
      { "RequiredTetrahedra", 1 },
      { "RequiredFaces", 1 },
      { "Normals", 3 },
      { "Tangents", 3 },
      { "NormalAtVertices", 2 },
      { "TangentAtVertices", 2 },
      { "NormalAtTriangleVertices", 3 },
      { "TangentAtEdges", 3 },
      { "RequiredQuadrilaterals", 1 },
      { "NormalAtQuadrilateralVertices", 3 },
      { "ParallelVertices", 1 },
      { "ParallelEdges", 1 },
      { "ParallelTriangles", 1 },
      { "SubDomainFromMesh", 4 },
    };

    class MeditReader
    {
    public:
      MeditReader(std::string bytes, const std::string &name)
          : text(std::move(bytes), name, "", '#'),
            builder([this](const std::string &message) { text.fail(message); })
      {
      }

      MshFile
      read()
      {
        if (text.at_end())
          text.fail("the file is empty. Save or copy the mesh again.");
        if (text.word("MeshVersionFormatted") != "MeshVersionFormatted")
          text.fail(
              "a Medit mesh begins with MeshVersionFormatted, this file does not. Binary ones "
              "(.meshb) are not read: save it as text.");
        if (const long long version = text.integer("the version"); version < 1 || version > 4)
          text.fail(fmt::format("MeshVersionFormatted {} is not known (1 to 4 are). Save the mesh "
                                "anew.",
                                version));
        bool is_ended = false;
        while (!is_ended && !text.at_end())
          is_ended = read_section(std::string(text.word("a section")));
        if (!is_ended)
          text.fail_at_end("the keyword End");
        for (const auto &[type, nodes, tag] : elements)
          builder.add_element(type, nodes, tag);
        return std::move(builder.msh);
      }

    private:
      struct Element
      {
        unsigned int           type;
        std::vector<long long> nodes;
        int                    tag;
      };

      bool
      read_section(const std::string &keyword)
      {
        if (keyword == "End")
          return true;
        if (keyword == "Dimension")
          read_dimension();
        else if (keyword == "Vertices")
          read_vertices();
        else
          read_others(keyword);
        return false;
      }

      void
      read_dimension()
      {
        if (const long long dimension = text.integer("the dimension"); dimension != 3)
          text.fail(fmt::format("Dimension is {}. Only bodies in space have a volume: mesh one in "
                                "three dimensions.",
                                dimension));
      }

      void
      read_vertices()
      {
        if (!builder.msh.nodes.empty())
          text.fail("the section Vertices appears twice. Save the mesh anew.");
        const std::size_t n = text.count("the number of vertices");
        for (std::size_t i = 0; i < n; ++i)
        {
          const std::string what = fmt::format("vertex {} of {}", i + 1, n);
          dealii::Point<3>  place;
          for (unsigned int d = 0; d < 3; ++d)
            place[d] = text.number(what);
          text.number(what); // its reference, which some write with decimals
          builder.add_node(place);
        }
      }

      void
      read_others(const std::string &keyword)
      {
        for (const MeditElement &kind : medit_elements)
          if (keyword == kind.keyword)
            return read_elements(kind);
        for (const PassedSection &section : passed_sections)
          if (keyword == section.keyword)
          {
            const std::size_t n = text.count("the number of " + keyword);
            for (std::size_t i = 0; i < n * section.n_words; ++i)
              text.number("an entry of " + keyword);
            return;
          }
        text.fail("the keyword '" + keyword.substr(0, 40)
                  + "' is not known here. Sections are Vertices, Edges, Triangles, Tetrahedra and "
                    "their marks; save the mesh anew without others.");
      }

      void
      read_elements(const MeditElement &kind)
      {
        const std::size_t n_nodes = find_msh_element_kind(kind.type)->n_nodes;
        const std::string keyword(kind.keyword);
        const std::size_t n = text.count("the number of " + keyword);
        for (std::size_t i = 0; i < n; ++i)
        {
          const std::string what = fmt::format("entry {} of {} of {}", i + 1, n, keyword);
          Element           element{ kind.type, {}, 0 };
          for (std::size_t v = 0; v < n_nodes; ++v)
            element.nodes.push_back(text.integer(what));
          exchange_last_edges(element.nodes);
          element.tag = builder.tag(text.integer(what), "the reference of " + what);
          elements.push_back(std::move(element));
        }
      }

      MeshText             text;
      MeshBuilder          builder;
      std::vector<Element> elements;
    };
  } // namespace

  MshFile
  read_medit(std::string bytes, const std::string &name)
  {
    return MeditReader(std::move(bytes), name).read();
  }
} // namespace Exemplar
