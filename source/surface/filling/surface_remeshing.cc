// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/surface/filling/surface_remeshing.h>
#include <exemplar/surface/shape/narrow_gaps.h>
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/vectors.h>

#include <algorithm>
#include <numeric>

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
    /// of triangles. Returns which triangle each one was before.
    std::vector<std::size_t>
    restore_order(const TriangleSurface &original, TriangleSurface &remeshed)
    {
      unsigned int             n_shells = 0;
      const auto               shell_of = matching_shells(original, remeshed, n_shells);
      std::vector<std::size_t> order(remeshed.triangles.size());
      std::iota(order.begin(), order.end(), 0);
      if (n_shells < 2)
        return order;
      const TriangleSurface before = remeshed;
      std::stable_sort(order.begin(), order.end(),
                       [&](const std::size_t a, const std::size_t b)
                       { return shell_of[a] < shell_of[b]; });
      for (std::size_t t = 0; t < order.size(); ++t)
      {
        remeshed.triangles[t] = before.triangles[order[t]];
        remeshed.groups[t]    = before.groups[order[t]];
      }
      return order;
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

    /// Distance from a filled gap within which triangles are held, over that from an intersection.
    constexpr double gap_reach = .3;

    /// Edges of held triangles that are thinned, over those of the others.
    constexpr double fineness = .18;

    /// Number of times that a surface is remeshed in search of one without intersections, and with
    /// the wanted number of cells.
    constexpr unsigned int most_remeshed = 60;

    double
    longest_side(const TriangleSurface &surface, const unsigned int triangle)
    {
      const auto &[a, b, c] = surface.triangles[triangle];
      const auto &x         = surface.vertices;
      return std::max(
          { norm(minus(x[a], x[b])), norm(minus(x[b], x[c])), norm(minus(x[c], x[a])) });
    }

    /// Mark the triangles of `surface` that are nearer than `distance` to those of `places`. Returns whether `places` has
    /// any.
    bool
    mark_near(const TriangleSurface &places,
              const TriangleSurface &surface,
              const double           distance,
              std::vector<bool>     &marked)
    {
      if (places.triangles.empty())
        return false;
      const NearestTriangle nearest(places);
      for (unsigned int t = 0; t < surface.triangles.size(); ++t)
        if (!marked[t] && nearest(middle_of(surface, t)).first < distance)
          marked[t] = true;
      return true;
    }

    /// Mark the triangles of `surface` that are nearer than `distance` to those of `remeshed` that
    /// intersect. Returns whether there are such.
    bool
    mark_near_intersections(const TriangleSurface &surface,
                            const TriangleSurface &remeshed,
                            const double           distance,
                            std::vector<bool>     &marked)
    {
      TriangleSurface intersecting{ remeshed.vertices, {}, {} };
      for (const auto &[first, second] : self_intersections(remeshed))
        for (const unsigned int triangle : { first, second })
          intersecting.triangles.push_back(remeshed.triangles[triangle]);
      return mark_near(intersecting, surface, distance, marked);
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
  } // namespace

  SheetRemeshing::SheetRemeshing(const TriangleSurface      &surface,
                                 const bool                  keep_edges,
                                 const NearSheets            near_sheets,
                                 const std::vector<OpenGap> &gaps,
                                 const std::string          &cells_option)
      : surface(surface), keep_edges(keep_edges), near_sheets(near_sheets), gaps(gaps),
        cells_option(cells_option)
  {
  }

  TriangleSurface
  SheetRemeshing::remesh_in_order(const double edge_length)
  {
    ++n_remeshed;
    TriangleSurface result = Exemplar::remesh(surface, shortening * edge_length, keep_edges, held);
    restore_order(surface, result);
    return result;
  }

  std::vector<bool>
  SheetRemeshing::are_open(const TriangleSurface &remeshed) const
  {
    std::vector<SpaceVector> middles;
    for (const OpenGap &gap : gaps)
      middles.push_back(gap.middle);
    return are_outside(remeshed, middles);
  }

  /// Forgets gaps that are closed whatever is held: some are too narrow for any other surface.
  void
  SheetRemeshing::give_up_closed_gaps(const TriangleSurface &remeshed)
  {
    if (gaps.empty())
      return;
    const std::vector<bool> open = are_open(remeshed);
    std::vector<OpenGap>    left;
    for (std::size_t i = 0; i < gaps.size(); ++i)
      if (open[i])
        left.push_back(gaps[i]);
    gaps = std::move(left);
  }

  /// Holds the triangles beside gaps that are filled in the remeshed surface. Returns whether there
  /// are such gaps.
  bool
  SheetRemeshing::mark_closed_gaps(const TriangleSurface &remeshed,
                                   const double           distance,
                                   std::vector<bool>     &marked) const
  {
    if (gaps.empty())
      return false;
    const std::vector<bool> open = are_open(remeshed);
    TriangleSurface         places{ {}, {}, {} };
    for (std::size_t i = 0; i < gaps.size(); ++i)
      if (!open[i])
      {
        const auto n = static_cast<unsigned int>(places.vertices.size());
        places.vertices.push_back(gaps[i].place);
        places.triangles.push_back({ { n, n, n } });
      }
    return mark_near(places, surface, distance, marked);
  }

  /// Remeshes the held triangles that are much finer than the cells, so that there are no more of
  /// them than sheets need that go their own way; but not where they would then intersect, or close
  /// gaps.
  void
  SheetRemeshing::thin_held(const double edge_length)
  {
    const double fine = fineness * edge_length;
    is_thinned.resize(held.size(), false);
    std::vector<Treatment> wanted(held.size(), Treatment::free);
    for (unsigned int t = 0; t < held.size(); ++t)
      if (held[t])
        wanted[t] = is_thinned[t] || 1.5 * longest_side(surface, t) > fine ? Treatment::held
                                                                           : Treatment::thinned;
    for (double distance = fine; distance < 4. * fine; distance *= 1.5)
    {
      if (std::find(wanted.begin(), wanted.end(), Treatment::thinned) == wanted.end())
        break;
      ++n_remeshed;
      std::vector<Treatment>         treatments = wanted;
      TriangleSurface                thinned    = thin(surface, fine, treatments);
      const std::vector<std::size_t> order      = restore_order(surface, thinned);
      std::vector<bool>              bad(held.size(), false);
      const bool                     is_sound = is_faultless(thinned);
      const bool has_bad = is_sound ? mark_closed_gaps(thinned, .5 * distance, bad)
                                    : mark_near_intersections(surface, thinned, distance, bad);
      if (!is_sound && !has_bad)
        break;
      if (!has_bad)
      {
        surface = std::move(thinned);
        held.clear();
        for (const std::size_t before : order)
          held.push_back(treatments[before] != Treatment::free);
        break;
      }
      for (std::size_t t = 0; t < wanted.size(); ++t)
        if (bad[t] && held[t])
          wanted[t] = Treatment::held;
    }
    is_thinned = held;
  }

  /// Holds the triangles that are near to intersections, first of `result` as it is given and then
  /// of what becomes of it. Returns whether it has become faultless.
  bool
  SheetRemeshing::hold(TriangleSurface &result, const double edge_length)
  {
    bool is_sound = is_faultless(result);
    for (double distance = edge_length; distance < 10. * edge_length; distance *= 1.5)
    {
      std::vector<bool> marked = held;
      marked.resize(surface.triangles.size(), false);
      const bool is_new = is_sound ? mark_closed_gaps(result, gap_reach * distance, marked)
                                   : mark_near_intersections(surface, result, distance, marked);
      if (is_sound && !is_new)
        return true;
      if (n_remeshed > most_remeshed)
        break;
      met_sheets = true;
      held       = std::move(marked);
      thin_held(edge_length);
      result   = remesh_in_order(edge_length);
      is_sound = is_faultless(result);
    }
    if (is_sound)
      give_up_closed_gaps(result);
    return is_sound;
  }

  /// Shortens all edges. Returns whether the surface has become faultless.
  bool
  SheetRemeshing::refine(TriangleSurface &result, const double edge_length)
  {
    met_sheets          = true;
    const double before = shortening;
    for (const double factor : { .8, .64 })
    {
      shortening = factor * before;
      result     = remesh_in_order(edge_length);
      if (is_faultless(result))
        return true;
    }
    shortening = before;
    return false;
  }

  TriangleSurface
  SheetRemeshing::remesh(const double edge_length)
  {
    const TriangleSurface evenly = remesh_in_order(edge_length);
    TriangleSurface       result = evenly;
    if (near_sheets == NearSheets::refined && !is_faultless(result) && n_remeshed < most_remeshed
        && refine(result, edge_length) && gaps.empty())
      return result;
    if (hold(result, edge_length))
      return result;
    if (near_sheets == NearSheets::held && n_remeshed < most_remeshed
        && refine(result, edge_length))
      return result;
    throw SolverFailure("The surface intersects itself" + place_of_crossing(evenly)
                        + " when its edges become " + short_text(edge_length) + " long"
                        + (n_remeshed < most_remeshed ? "" : ", and in many more attempts")
                        + ". Ask for more cells (" + cells_option
                        + "), or thicken its thin parts there.");
  }
} // namespace Exemplar
