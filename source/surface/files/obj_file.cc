// SPDX-License-Identifier: GPL-3.0-or-later
// Format: Wavefront, "Object Files (.obj)", Advanced Visualizer manual, appendix B1.
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/surface/files/surface_formats.h>
#include <exemplar/surface/files/surface_scanner.h>
#include <exemplar/surface/files/write_obj.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace Exemplar
{
  namespace
  {
    /// Statements that say nothing of where the surface is.
    constexpr std::array<std::string_view, 13> ignored{ { "vn", "vp", "p", "l", "mg", "usemap",
                                                          "maplib", "bevel", "c_interp", "d_interp",
                                                          "lod", "shadow_obj", "trace_obj" } };

    /// Statements that tell of the faces behind them; the first three make groups.
    constexpr std::array<std::string_view, 5> kept{ { "g", "usemtl", "o", "s", "mtllib" } };

    /// Names that a face has by g, usemtl and o.
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
      read_texture_point();
      void
      read_face();
      std::size_t
      n_words_before_comment() const;
      unsigned int
      vertex_of(std::string_view corner) const;
      void
      add_texture_of_face(std::size_t n_corners);
      void
      check_indices() const;
      void
      drop_wrong_textures();

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
      drop_wrong_textures();

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
      else if (keyword == "vt")
        read_texture_point();
      else if (keyword == "f" || keyword == "fo") // fo is the older name
        read_face();
      else if (const auto kind = std::find(kept.begin(), kept.end(), keyword); kind != kept.end())
      {
        surface.face_statements.emplace_back(surface.faces.size(), in.rest_of_line(0));
        if (const auto k = static_cast<std::size_t>(kind - kept.begin()); k < current.size())
          current[k] = in.rest_of_line(1);
      }
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
        in.fail(fmt::format(
            "a vertex has three coordinates (v x y z), found {} numbers. Export the surface anew.",
            n));
      surface.vertices.push_back({ { in.number(1), in.number(2), in.number(3) } });
      require_few(in, surface.vertices.size(), "vertices");
    }

    /// Reads vt; a word that is no number stands for 0.
    void
    ObjReader::read_texture_point()
    {
      std::array<double, 2> point{ { 0., 0. } };
      for (std::size_t i = 1; i <= std::min<std::size_t>(2, n_words_before_comment() - 1); ++i)
        if (const double number = parse_number(std::string(in.words()[i])); std::isfinite(number))
          point[i - 1] = number;
      surface.texture_points.push_back(point);
    }

    void
    ObjReader::read_face()
    {
      const std::size_t n = n_words_before_comment() - 1;
      if (n < 3)
        in.fail(fmt::format("a face has at least three vertices, found {}. Delete the face, or "
                            "export the surface anew.",
                            n));
      std::vector<unsigned int> face;
      for (std::size_t i = 1; i <= n; ++i)
        face.push_back(vertex_of(in.words()[i]));
      if (distinct.empty() || distinct.back() != current)
        distinct.push_back(current);
      face_combinations.push_back(static_cast<unsigned int>(distinct.size() - 1));
      face_lines.push_back(in.line());
      add_texture_of_face(n);
      surface.faces.push_back(std::move(face));
      require_few(in, surface.faces.size(), "faces");
    }

    /// Texture points of a face, from corners i/j or i/j/k. Invalid or missing numbers count as
    /// none, so that a surface may be used whose texture may not.
    void
    ObjReader::add_texture_of_face(const std::size_t n_corners)
    {
      std::vector<unsigned int> points;
      const auto                n = static_cast<long long>(surface.texture_points.size());
      for (std::size_t i = 1; i <= n_corners; ++i)
      {
        const std::string_view corner = in.words()[i];
        const auto             begin  = corner.find('/');
        if (begin == std::string_view::npos)
          break;
        const std::string_view number
            = corner.substr(begin + 1, corner.find('/', begin + 1) - begin - 1);
        long long index = 0;
        std::from_chars(number.data(), number.data() + number.size(), index);
        if (index == 0 || index < -n || index > std::numeric_limits<unsigned int>::max() / 4)
          break;
        points.push_back(static_cast<unsigned int>(index > 0 ? index - 1 : n + index));
      }
      if (points.size() < n_corners)
        points.clear();
      if (points.empty() && surface.face_texture_points.empty())
        return; // no face has had texture points so far
      surface.face_texture_points.resize(surface.faces.size());
      surface.face_texture_points.push_back(std::move(points));
    }

    void
    ObjReader::drop_wrong_textures()
    {
      if (surface.face_texture_points.empty())
        surface.texture_points.clear();
      else
        surface.face_texture_points.resize(surface.faces.size());
      for (auto &points : surface.face_texture_points)
        if (std::any_of(points.begin(), points.end(),
                        [&](const unsigned int p) { return p >= surface.texture_points.size(); }))
          points.clear();
    }

    /// The vertex of a corner i, i/j, i//k or i/j/k, where -1 is the vertex read last; k, the
    /// normal, is ignored.
    unsigned int
    ObjReader::vertex_of(const std::string_view corner) const
    {
      const long long index = in.integer(corner.substr(0, corner.find('/')));
      const auto      n     = static_cast<long long>(surface.vertices.size());
      if (index == 0 || index < -n || index > std::numeric_limits<unsigned int>::max() / 4)
        in.fail(fmt::format("a face uses vertex {}, but {}. Export the surface anew.", index,
                            index == 0 ? "vertices are counted from 1"
                                       : fmt::format("there are {} before this line", n)));
      return static_cast<unsigned int>(index > 0 ? index - 1 : n + index);
    }

    /// Checks vertex numbers after reading, because vertices may follow the faces that use them.
    void
    ObjReader::check_indices() const
    {
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (const unsigned int vertex : surface.faces[f])
          if (vertex >= surface.vertices.size())
            in.fail_at_line(
                face_lines[f],
                fmt::format(
                    "a face uses vertex {}, but the file has {} vertices. Export the surface anew.",
                    vertex + 1, surface.vertices.size()));
    }
  } // namespace

  SurfaceMesh
  read_obj(SurfaceScanner &in)
  {
    return ObjReader(in).read();
  }

  std::string
  obj_vertices(const std::vector<SurfaceMesh::Vertex> &vertices)
  {
    std::string text;
    text.reserve(60 * vertices.size());
    for (const auto &vertex : vertices)
    {
      text += 'v';
      for (const double coordinate : vertex)
        (text += ' ') += shortest_text(coordinate);
      text += '\n';
    }
    return text;
  }

  std::string
  obj_faces(const SurfaceMesh &surface)
  {
    std::string text;
    for (const auto &point : surface.texture_points)
      text += "vt " + shortest_text(point[0]) + ' ' + shortest_text(point[1]) + '\n';
    std::size_t statement = 0;
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
    {
      if (!surface.face_groups.empty() && surface.face_statements.empty()
          && (f == 0 || surface.face_groups[f] != surface.face_groups[f - 1]))
        text += "g " + surface.group_names[surface.face_groups[f]] + '\n';
      for (; statement < surface.face_statements.size()
             && surface.face_statements[statement].first <= f;
           ++statement)
        text += surface.face_statements[statement].second + '\n';
      text += 'f';
      for (std::size_t i = 0; i < surface.faces[f].size(); ++i)
      {
        text += fmt::format(" {}", surface.faces[f][i] + 1);
        if (!surface.face_texture_points.empty() && !surface.face_texture_points[f].empty())
          text += fmt::format("/{}", surface.face_texture_points[f][i] + 1);
      }
      text += '\n';
    }
    return text;
  }

  void
  write_obj(const SurfaceMesh &surface, const std::filesystem::path &file)
  {
    AtomicFile atomic_file(file);
    atomic_file.stream() << obj_vertices(surface.vertices) << obj_faces(surface);
    atomic_file.commit();
  }
} // namespace Exemplar
