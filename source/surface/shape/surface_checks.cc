// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/vectors.h>

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace Exemplar
{
  namespace
  {
    /// The checks of one surface; each may rely on those before.
    class SurfaceCheck
    {
    public:
      explicit SurfaceCheck(const CheckedSurface &c)
          : checked(c), surface(c.surface), sides(sorted_sides(c.surface))
      {
        findings.n_shells = number_shells(surface, sides, findings.shells);
      }

      SurfaceFindings
      run()
      {
        note_unused();
        note_duplicates();
        find_flat();
        find_holes();
        find_crowded_edges();
        find_turned();
        const bool sides_fit = n_crowded == 0 && n_turned == 0 && n_flat == 0;
        if (sides_fit)
        {
          find_fans();
          find_intersections();
        }
        if (findings.faults.empty())
          find_shells();
        return std::move(findings);
      }

    private:
      void
      note_unused();
      void
      note_duplicates();
      void
      find_flat();
      void
      find_holes();
      void
      find_crowded_edges();
      void
      find_turned();
      void
      find_fans();
      void
      find_intersections();
      void
      find_shells();

      std::string
      vertex_text(const unsigned int vertex) const
      {
        return fmt::format("vertex {} {}", vertex + 1, place_text(surface.vertices[vertex]));
      }

      /// "faces 3, 7 and 9", each once.
      std::string
      face_numbers(const std::vector<unsigned int> &triangles) const
      {
        std::set<std::size_t> numbers;
        for (const unsigned int t : triangles)
          numbers.insert((checked.faces.empty() ? t : checked.faces[t]) + std::size_t(1));
        return std::string(numbers.size() == 1 ? "face " : "faces ")
               + list_numbers({ numbers.begin(), numbers.end() });
      }

      void
      add_fault(const std::string &what, const std::size_t n, const std::string &where)
      {
        findings.faults.push_back(fmt::format("{}: {} ({})", what, n, where));
      }

      void
      add_faces(const std::string &fault, const std::vector<unsigned int> &triangles)
      {
        for (const unsigned int t : triangles)
          findings.elements.push_back(
              { fault, true, checked.faces.empty() ? t : checked.faces[t] });
      }

      void
      add_vertex(const std::string &fault, const unsigned int vertex)
      {
        findings.elements.push_back({ fault, false, vertex });
      }

      void
      add_shell(const std::string &fault, const unsigned int shell)
      {
        for (unsigned int t = 0; t < findings.shells.size(); ++t)
          if (findings.shells[t] == shell)
            add_faces(fault, { t });
      }

      const CheckedSurface           &checked;
      const TriangleSurface          &surface;
      const std::vector<TriangleSide> sides;
      SurfaceFindings                 findings;
      std::size_t                     n_flat = 0, n_crowded = 0, n_turned = 0;
    };

    void
    SurfaceCheck::note_unused()
    {
      std::vector<bool> used(surface.vertices.size(), false);
      for (const auto &t : surface.triangles)
        for (const unsigned int vertex : t)
          used[vertex] = true;
      std::vector<std::size_t> numbers;
      for (std::size_t i = 0; i < used.size(); ++i)
        if (!used[i])
          numbers.push_back(i + 1);
      if (!numbers.empty())
        findings.notes.push_back(fmt::format("unused vertices: {} (vertices {}), left out",
                                             numbers.size(), list_numbers(numbers)));
    }

    void
    SurfaceCheck::note_duplicates()
    {
      std::map<SpaceVector, unsigned int> first;
      std::vector<std::size_t>            numbers;
      for (unsigned int i = 0; i < surface.vertices.size(); ++i)
        if (!first.emplace(surface.vertices[i], i).second)
          numbers.push_back(i + 1);
      if (!numbers.empty())
        findings.notes.push_back(
            fmt::format("duplicate vertices: {} (at the place of an earlier one: vertices {})",
                        numbers.size(), list_numbers(numbers)));
    }

    /// Finds triangles without area, flat by the tolerance of orient_tetrahedra().
    void
    SurfaceCheck::find_flat()
    {
      std::vector<unsigned int> flat;
      for (unsigned int t = 0; t < surface.triangles.size(); ++t)
      {
        double longest = 0.; // square of the longest edge
        for (unsigned int k = 0; k < 3; ++k)
        {
          const SpaceVector side = minus(surface.vertices[surface.triangles[t][(k + 1) % 3]],
                                         surface.vertices[surface.triangles[t][k]]);
          longest                = std::max(longest, dot(side, side));
        }
        if (area_of(surface, t) <= 1e-10 * longest)
          flat.push_back(t);
      }
      n_flat = flat.size();
      add_faces("faces without area", flat);
      if (n_flat > 0)
        add_fault("faces without area", n_flat, face_numbers(flat));
    }

    void
    SurfaceCheck::find_holes()
    {
      std::vector<TriangleSide> open;
      for_each_edge(sides,
                    [&](const TriangleSide *const first, const TriangleSide *const last)
                    {
                      if (last - first == 1)
                        open.push_back(*first);
                    });
      if (open.empty())
        return;
      UnionFind together(surface.vertices.size());
      for (const TriangleSide &side : open)
        together.join(side.vertices[0], side.vertices[1]);
      std::map<unsigned int, std::size_t> n_edges; // of a hole, at its first vertex
      for (const TriangleSide &side : open)
      {
        ++n_edges[together.root(side.vertices[0])];
        for (const unsigned int vertex : side.vertices)
          add_vertex("holes", vertex);
      }
      const auto largest
          = std::max_element(n_edges.begin(), n_edges.end(),
                             [](const auto &a, const auto &b) { return a.second < b.second; });
      add_fault("holes", n_edges.size(),
                fmt::format("with {} open edges; the largest has {}, at {}", open.size(),
                            largest->second, vertex_text(largest->first)));
    }

    void
    SurfaceCheck::find_crowded_edges()
    {
      std::vector<unsigned int> triangles;
      unsigned int              a_vertex = 0;
      for_each_edge(sides,
                    [&](const TriangleSide *const first, const TriangleSide *const last)
                    {
                      if (last - first <= 2)
                        return;
                      if (n_crowded++ == 0)
                        a_vertex = first->vertices[0];
                      for (const TriangleSide *side = first; side != last; ++side)
                        triangles.push_back(side->triangle);
                    });
      add_faces("edges of more than two faces", triangles);
      if (n_crowded > 0)
        add_fault("edges of more than two faces", n_crowded,
                  "the first at " + vertex_text(a_vertex) + "; " + face_numbers(triangles));
    }

    void
    SurfaceCheck::find_turned()
    {
      TriangleSurface turned_surface = surface;
      const auto      turned         = turn_to_majority(turned_surface);
      n_turned                       = turned.size();
      add_faces("faces turned against their neighbours", turned);
      if (n_turned > 0)
        add_fault("faces turned against their neighbours", n_turned, face_numbers(turned));
      if (n_crowded > 0)
        return;
      // sides that no turning makes consistent: a Moebius strip
      const auto turned_sides = sorted_sides(turned_surface);
      for_each_edge(turned_sides,
                    [&](const TriangleSide *const first, const TriangleSide *const last)
                    {
                      if (last - first != 2 || first[0].forward != first[1].forward)
                        return;
                      add_faces("one-sided", { first[0].triangle, first[1].triangle });
                      if (++n_turned == turned.size() + 1)
                        findings.faults.push_back("one-sided: the surface has no inside (at "
                                                  + vertex_text(first->vertices[0]) + ")");
                    });
    }

    void
    SurfaceCheck::find_fans()
    {
      UnionFind  fans(3 * surface.triangles.size()); // sets of corners
      const auto join = [&](const TriangleSide &a, const TriangleSide &b)
      {
        // the triangles go through their edge in opposite directions
        fans.join(3 * a.triangle + a.corner, 3 * b.triangle + (b.corner + 1) % 3);
        fans.join(3 * a.triangle + (a.corner + 1) % 3, 3 * b.triangle + b.corner);
      };
      for_each_edge(sides,
                    [&](const TriangleSide *const first, const TriangleSide *const last)
                    {
                      if (last - first == 2)
                        join(first[0], first[1]);
                    });
      std::vector<unsigned int> n_fans(surface.vertices.size(), 0);
      for (unsigned int c = 0; c < 3 * surface.triangles.size(); ++c)
        if (fans.root(c) == c)
          ++n_fans[surface.triangles[c / 3][c % 3]];
      std::vector<std::size_t> numbers;
      for (std::size_t i = 0; i < n_fans.size(); ++i)
        if (n_fans[i] > 1)
        {
          numbers.push_back(i + 1);
          add_vertex("vertices where the surface touches itself", static_cast<unsigned int>(i));
        }
      if (!numbers.empty())
        add_fault("vertices where the surface touches itself", numbers.size(),
                  "vertices " + list_numbers(numbers) + "; the first at "
                      + place_text(surface.vertices[numbers[0] - 1]));
      n_crowded += numbers.size();
    }

    void
    SurfaceCheck::find_intersections()
    {
      if (n_crowded > 0)
        return;
      const auto pairs = self_intersections(surface);
      if (pairs.empty())
        return;
      std::vector<unsigned int> triangles;
      for (const auto &[a, b] : pairs)
        triangles.insert(triangles.end(), { a, b });
      add_faces("pairs of intersecting faces", triangles);
      add_fault("pairs of intersecting faces", pairs.size(),
                "the first at " + vertex_text(surface.triangles[pairs[0].first][0]) + "; "
                    + face_numbers(triangles));
    }

    /// Notes shells side by side, and finds those that are inside out. Precondition: closed shells that do not intersect.
    void
    SurfaceCheck::find_shells()
    {
      const auto around = enclosing_shells(surface, findings.shells, findings.n_shells);
      const auto n_free = std::count(around.begin(), around.end(), findings.n_shells);
      if (n_free > 1)
      {
        constexpr std::size_t most_shown = 4;
        std::size_t           n_shown    = 0;
        std::string           where;
        for (unsigned int shell = 0; shell < findings.n_shells && n_shown < most_shown; ++shell)
          if (around[shell] == findings.n_shells)
          {
            const TriangleSurface part = shell_of(surface, findings.shells, shell);
            where += fmt::format("{}{} triangles at {}", n_shown++ == 0 ? "" : ", ",
                                 part.triangles.size(),
                                 place_text(part.vertices[part.triangles[0][0]]));
          }
        findings.notes.push_back(fmt::format(
            "{} shells side by side ({}{}), each of which becomes a piece of its own", n_free,
            where, n_free > static_cast<std::ptrdiff_t>(most_shown) ? ", ..." : ""));
      }
      for (unsigned int shell = 0; shell < findings.n_shells; ++shell)
        if (around[shell] == findings.n_shells
            && enclosed_volume(shell_of(surface, findings.shells, shell)) < 0.)
        {
          add_shell("inside out", shell);
          findings.faults.push_back("inside out: the faces of a shell point inwards, all of them");
        }
    }
  } // namespace

  SurfaceFindings
  check_surface(const CheckedSurface &checked)
  {
    return SurfaceCheck(checked).run();
  }
} // namespace Exemplar
