// SPDX-License-Identifier: GPL-3.0-or-later
// Format: Wavefront, "Object Files (.obj)", Advanced Visualizer manual, appendix B1.
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/surface/surface_formats.h>
#include <exemplar/surface/surface_scanner.h>
#include <exemplar/surface/write_obj.h>

#include <algorithm>
#include <array>
#include <limits>

namespace Exemplar
{
  namespace
  {
    /// Statements that say nothing of where the surface is.
    constexpr std::array<std::string_view, 16> ignored{
      { "vt", "vn", "vp", "p", "l", "s", "mg", "mtllib", "usemap", "maplib", "bevel", "c_interp",
        "d_interp", "lod", "shadow_obj", "trace_obj" }
    };

    /// What a face belongs to by g, usemtl and o.
    using ObjGroups = std::array<std::string, 3>;

    class ObjReader
    {
    public:
      explicit ObjReader(SurfaceScanner &scanner) : in(scanner) {}

      SurfaceMesh
      read();

    private:
      void
      read_statement(std::string_view keyword);
      void
      read_vertex();
      void
      read_face();
      std::size_t
      n_words_before_comment() const;
      unsigned int
      vertex_of(std::string_view corner) const;
      void
      check_indices() const;

      SurfaceScanner           &in;
      SurfaceMesh               surface;
      ObjGroups                 current;
      std::vector<ObjGroups>    distinct; ///< combinations, in order of appearance
      std::vector<unsigned int> face_combinations;
      std::vector<std::size_t>  face_lines;
    };

    SurfaceMesh
    ObjReader::read()
    {
      while (in.next_line(true))
        read_statement(in.words()[0]);
      check_indices();

      unsigned int kind = 0;
      while (kind < 2
             && std::all_of(distinct.begin(), distinct.end(),
                            [&](const ObjGroups &groups) { return groups[kind].empty(); }))
        ++kind;
      auto faces = std::move(surface.faces);
      surface.faces.clear();
      GroupedFaces grouped(surface);
      for (std::size_t f = 0; f < faces.size(); ++f)
        grouped.add(std::move(faces[f]), distinct[face_combinations[f]][kind]);
      grouped.finish();
      return std::move(surface);
    }

    void
    ObjReader::read_statement(const std::string_view keyword)
    {
      if (keyword[0] == '#')
        return;
      if (keyword == "v")
        read_vertex();
      else if (keyword == "f" || keyword == "fo") // fo is the older name
        read_face();
      else if (keyword == "g")
        current[0] = in.rest_of_line(1);
      else if (keyword == "usemtl")
        current[1] = in.rest_of_line(1);
      else if (keyword == "o")
        current[2] = in.rest_of_line(1);
      else if (keyword == "surf" || keyword == "curv" || keyword == "cstype")
        in.fail("free-form curves and surfaces (" + std::string(keyword)
                + ") are not supported. Convert them to polygons before exporting.");
      else if (std::find(ignored.begin(), ignored.end(), keyword) == ignored.end())
        in.fail("expected a statement of an .obj file (such as v, f, g, usemtl), found "
                + in_quotes(keyword) + ". Is it an .obj file? Export the surface anew.");
    }

    std::size_t
    ObjReader::n_words_before_comment() const
    {
      const auto &words = in.words();
      return static_cast<std::size_t>(
          std::find_if(words.begin(), words.end(), [](const auto &word) { return word[0] == '#'; })
          - words.begin());
    }

    void
    ObjReader::read_vertex()
    {
      // a fourth number is a weight of rational curves; six or seven end with a colour
      const std::size_t n = n_words_before_comment() - 1;
      if (n != 3 && n != 4 && n != 6 && n != 7)
        in.fail("a vertex has three coordinates (v x y z), found " + std::to_string(n)
                + " numbers. Export the surface anew.");
      surface.vertices.push_back({ { in.number(1), in.number(2), in.number(3) } });
      require_few(in, surface.vertices.size(), "vertices");
    }

    void
    ObjReader::read_face()
    {
      const std::size_t n = n_words_before_comment() - 1;
      if (n < 3)
        in.fail("a face has at least three vertices, found " + std::to_string(n)
                + ". Delete the face, or export the surface anew.");
      std::vector<unsigned int> face;
      for (std::size_t i = 1; i <= n; ++i)
        face.push_back(vertex_of(in.words()[i]));
      if (distinct.empty() || distinct.back() != current)
        distinct.push_back(current);
      face_combinations.push_back(static_cast<unsigned int>(distinct.size() - 1));
      face_lines.push_back(in.line());
      surface.faces.push_back(std::move(face));
      require_few(in, surface.faces.size(), "faces");
    }

    /// Of i, i/j, i//k or i/j/k; -1 is the vertex read last. The texture's and the normal's
    /// number are not looked at.
    unsigned int
    ObjReader::vertex_of(const std::string_view corner) const
    {
      const long long index = in.integer(corner.substr(0, corner.find('/')));
      const auto      n     = static_cast<long long>(surface.vertices.size());
      if (index == 0 || index < -n || index > std::numeric_limits<unsigned int>::max() / 4)
        in.fail("a face uses vertex " + std::to_string(index) + ", but "
                + (index == 0 ? "vertices are counted from 1"
                              : "there are " + std::to_string(n) + " before this line")
                + ". Export the surface anew.");
      return static_cast<unsigned int>(index > 0 ? index - 1 : n + index);
    }

    /// At the end, because vertices may follow the faces that use them.
    void
    ObjReader::check_indices() const
    {
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (const unsigned int vertex : surface.faces[f])
          if (vertex >= surface.vertices.size())
            in.fail_at_line(face_lines[f], "a face uses vertex " + std::to_string(vertex + 1)
                                               + ", but the file has "
                                               + std::to_string(surface.vertices.size())
                                               + " vertices. Export the surface anew.");
    }
  } // namespace

  SurfaceMesh
  read_obj(SurfaceScanner &in)
  {
    return ObjReader(in).read();
  }

  void
  write_obj(const SurfaceMesh &surface, const std::filesystem::path &file)
  {
    AtomicFile    atomic_file(file);
    std::ostream &out = atomic_file.stream();
    for (const auto &vertex : surface.vertices)
      out << "v " << shortest_text(vertex[0]) << ' ' << shortest_text(vertex[1]) << ' '
          << shortest_text(vertex[2]) << '\n';
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
    {
      if (!surface.face_groups.empty()
          && (f == 0 || surface.face_groups[f] != surface.face_groups[f - 1]))
        out << "g " << surface.group_names[surface.face_groups[f]] << '\n';
      out << 'f';
      for (const unsigned int vertex : surface.faces[f])
        out << ' ' << std::to_string(vertex + 1);
      out << '\n';
    }
    atomic_file.commit();
  }
} // namespace Exemplar
