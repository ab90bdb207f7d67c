// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/surface/filling/surface_remeshing.h>
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/vectors.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace Exemplar
{
  namespace
  {
    /// The shell of `to` that most vertices of each shell of `from` are nearest to.
    std::vector<unsigned int>
    matching_shells(const TriangleSurface &from, const TriangleSurface &to, unsigned int &n_shells)
    {
      std::vector<unsigned int> shells, shells_to;
      n_shells                                   = number_shells(from, sorted_sides(from), shells);
      const unsigned int                    n_to = number_shells(to, sorted_sides(to), shells_to);
      std::vector<std::vector<std::size_t>> votes(n_shells, std::vector<std::size_t>(n_to));
      if (n_shells > 1)
      {
        const NearestTriangle nearest(to);
        for (std::size_t t = 0; t < from.triangles.size(); ++t)
          for (const unsigned int vertex : from.triangles[t])
            ++votes[shells[t]][shells_to[nearest(from.vertices[vertex]).second]];
      }
      std::vector<unsigned int> rank(n_to, n_shells);
      for (unsigned int shell = n_shells; shell-- > 0;)
        rank[std::max_element(votes[shell].begin(), votes[shell].end()) - votes[shell].begin()]
            = shell;
      std::vector<unsigned int> of_triangle;
      for (const unsigned int shell : shells_to)
        of_triangle.push_back(rank[shell]);
      return of_triangle;
    }

    /// Restores the order of the shells, by which regions are numbered: remeshing changes the order
    /// of triangles.
    void
    restore_order(const TriangleSurface &original, TriangleSurface &remeshed)
    {
      unsigned int n_shells = 0;
      const auto   shell_of = matching_shells(original, remeshed, n_shells);
      if (n_shells < 2)
        return;
      const TriangleSurface    before = remeshed;
      std::vector<std::size_t> order(shell_of.size());
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(),
                       [&](const std::size_t a, const std::size_t b)
                       { return shell_of[a] < shell_of[b]; });
      for (std::size_t t = 0; t < order.size(); ++t)
      {
        remeshed.triangles[t] = before.triangles[order[t]];
        remeshed.groups[t]    = before.groups[order[t]];
      }
    }

    TriangleSurface
    remesh_in_order(const TriangleSurface   &surface,
                    const double             edge_length,
                    const bool               keep_edges,
                    const std::vector<bool> &held = {})
    {
      TriangleSurface result = remesh(surface, edge_length, keep_edges, held);
      restore_order(surface, result);
      return result;
    }

    bool
    is_faultless(const TriangleSurface &surface)
    {
      return check_surface({ surface, {} }).faults.empty();
    }

    SurfaceMesh::Vertex
    middle_of(const TriangleSurface &surface, const unsigned int triangle)
    {
      const auto &[a, b, c] = surface.triangles[triangle];
      const auto &x         = surface.vertices;
      return plus(x[a], 1. / 3., plus(minus(x[b], x[a]), 1., minus(x[c], x[a])));
    }

    /// Mark the triangles of `surface` that are nearer than `distance` to those of `remeshed` that
    /// intersect.
    void
    mark_near_intersections(const TriangleSurface &surface,
                            const TriangleSurface &remeshed,
                            const double           distance,
                            std::vector<bool>     &marked)
    {
      TriangleSurface intersecting{ remeshed.vertices, {}, {} };
      for (const auto &[first, second] : self_intersections(remeshed))
        for (const unsigned int triangle : { first, second })
          intersecting.triangles.push_back(remeshed.triangles[triangle]);
      if (intersecting.triangles.empty())
        return;
      const NearestTriangle nearest(intersecting);
      for (unsigned int t = 0; t < surface.triangles.size(); ++t)
        if (!marked[t] && nearest(middle_of(surface, t)).first < distance)
          marked[t] = true;
    }

    std::string
    place_of_crossing(const TriangleSurface &surface)
    {
      const auto crossing = self_intersections(surface);
      if (crossing.empty())
        return "";
      const auto &[x, y, z] = middle_of(surface, crossing.front().first);
      return " near " + short_text(x) + ", " + short_text(y) + ", " + short_text(z);
    }

    /// Remeshes with the triangles held that are near to intersections, first of `evenly` and then
    /// of the result; none if that does not help.
    std::optional<TriangleSurface>
    hold_near_sheets(const TriangleSurface &surface,
                     const double           edge_length,
                     const bool             keep_edges,
                     const TriangleSurface &evenly)
    {
      std::vector<bool> held(surface.triangles.size(), false);
      TriangleSurface   result = evenly;
      for (double distance = edge_length; distance < 10. * edge_length; distance *= 1.5)
      {
        mark_near_intersections(surface, result, distance, held);
        result = remesh_in_order(surface, edge_length, keep_edges, held);
        if (is_faultless(result))
          return result;
      }
      return {};
    }

    /// Remeshes with shorter edges; none if that does not help.
    std::optional<TriangleSurface>
    refine(const TriangleSurface &surface, const double edge_length, const bool keep_edges)
    {
      for (const double factor : { .8, .64 })
        if (TriangleSurface finer = remesh_in_order(surface, factor * edge_length, keep_edges);
            is_faultless(finer))
          return finer;
      return {};
    }
  } // namespace

  Remeshed
  remesh_without_intersections(const TriangleSurface &surface,
                               const double           edge_length,
                               const bool             keep_edges,
                               const NearSheets       near_sheets,
                               const std::string     &cells_option)
  {
    TriangleSurface evenly = remesh_in_order(surface, edge_length, keep_edges);
    if (is_faultless(evenly))
      return { std::move(evenly), false };
    for (const bool first : { true, false })
    {
      const bool holds  = (near_sheets == NearSheets::held) == first;
      auto       result = holds ? hold_near_sheets(surface, edge_length, keep_edges, evenly)
                                : refine(surface, edge_length, keep_edges);
      if (result)
        return { std::move(*result), true };
    }
    throw SolverFailure("The surface intersects itself" + place_of_crossing(evenly)
                        + " when its edges become " + short_text(edge_length)
                        + " long. Ask for more cells (" + cells_option
                        + "), or thicken its thin parts there.");
  }
} // namespace Exemplar
