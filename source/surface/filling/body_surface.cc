// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/surface/filling/body_surface.h>
#include <exemplar/surface/filling/surface_meshing.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/surface_repair.h>
#include <exemplar/surface/shape/vectors.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    std::string
    list_lines(const std::vector<std::string> &lines)
    {
      std::string text;
      for (const std::string &line : lines)
        text += "\n  " + line;
      return text;
    }

    void
    append(std::vector<std::string> &to, const std::vector<std::string> &lines)
    {
      to.insert(to.end(), lines.begin(), lines.end());
    }

    std::string
    movement_text(const TriangleSurface &from, const TriangleSurface &to)
    {
      const double          diagonal = diagonal_of(from.vertices);
      const SurfaceDistance out      = distance_to(NearestTriangle(to), from);
      const SurfaceDistance back     = distance_to(NearestTriangle(from), to);
      return "the old surface is at most " + short_text(100. * out.maximum / diagonal)
             + " % of its diagonal from the new one (mean " + short_text(100. * out.mean / diagonal)
             + " %), the new one at most " + short_text(100. * back.maximum / diagonal)
             + " % from the old one (mean " + short_text(100. * back.mean / diagonal) + " %)";
    }

    /// Size of the openings that a wrap closes, over the diagonal. A finer wrap than the cells need
    /// costs minutes for nothing.
    double
    openings(const unsigned int n_cells)
    {
      return std::max(.01, .25 / std::cbrt(n_cells));
    }

    /// Whether a wrap at a distance is no body: it has gone through an opening and runs along both
    /// sides of the surface, so that its volume is its area times the distance. Parts as thick as
    /// the openings that are closed have ten times that.
    bool
    is_thin_shell(const TriangleSurface &wrapped, const double distance)
    {
      double area = 0.;
      for (std::size_t t = 0; t < wrapped.triangles.size(); ++t)
        area += area_of(wrapped, t);
      return std::abs(enclosed_volume(wrapped)) < 4. * area * distance;
    }

    /// Wraps the surface; returns the faults that are left.
    std::vector<std::string>
    wrap_surface(BodySurface &body, const double openings)
    {
      body.surface = wrap(body.original, openings);
      if (is_thin_shell(body.surface,
                        wrap_distance * openings * diagonal_of(body.original.vertices)))
        return { "openings wider than " + short_text(100. * openings)
                 + " % of the diagonal, through which the wrap goes: fill them, or ask for fewer "
                   "cells, which wraps more coarsely" };
      return check_surface({ body.surface, {} }).faults;
    }

    /// Repairs the surface and, if there are still faults, wraps it. Returns the faults of the last
    /// attempt.
    std::vector<std::string>
    mend_surface(BodySurface &body, const unsigned int n_cells)
    {
      RepairedSurface          repaired = repair(body.original);
      std::vector<std::string> faults{ "nothing is left of it" };
      if (!repaired.surface.triangles.empty())
        faults = check_surface({ repaired.surface, {} }).faults;
      if (faults.empty())
      {
        append(body.notes, repaired.done);
        body.surface = std::move(repaired.surface);
      }
      else
      {
        body.notes.push_back("repair was not enough, so the surface was wrapped; left were:");
        append(body.notes, faults);
        faults = wrap_surface(body, openings(n_cells));
      }
      if (faults.empty())
        body.notes.push_back(movement_text(body.original, body.surface));
      return faults;
    }
    /// Whether all vertices lie in a plane.
    bool
    is_flat(const TriangleSurface &surface)
    {
      const double size   = diagonal_of(surface.vertices);
      SpaceVector  normal = { { 0., 0., 0. } };
      for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      {
        const auto       &corner = surface.triangles[t];
        const SpaceVector a      = surface.vertices[corner[0]];
        const SpaceVector n
            = cross(minus(surface.vertices[corner[1]], a), minus(surface.vertices[corner[2]], a));
        normal = norm(n) > norm(normal) ? n : normal;
      }
      return std::all_of(surface.vertices.begin(), surface.vertices.end(),
                         [&](const SpaceVector &x) {
                           return std::abs(dot(minus(x, surface.vertices[0]), normal))
                                  <= 1e-9 * size * norm(normal);
                         });
    }
  } // namespace

  BodySurface
  make_body_surface(const SurfaceMesh &read, const SurfaceMeshingOptions &options)
  {
    const std::filesystem::path &file = options.surface;
    CheckedSurface               checked;
    checked.surface                = triangulate(read, &checked.faces);
    const SurfaceFindings findings = check_surface(checked);
    BodySurface body{ checked.surface, checked.surface, read.group_names, findings.notes };
    if (is_flat(checked.surface))
      throw UserError(file.string()
                      + ": the surface does not bound a body:" + list_lines(findings.faults)
                      + "\n  It lies in a plane, and a sheet has no inside: give it a thickness "
                        "where it was made.");
    if (!findings.faults.empty() && !options.repair)
      throw UserError(
          file.string() + ": the surface does not bound a body:" + list_lines(findings.faults)
          + list_lines(findings.notes) + "\n  Mend it in the program that made it, or try "
          + options.repair_option
          + ". Vertices and faces are counted from 1; for a table of all: exemplar mesh "
            "--surface "
          + file.string() + " --list-faults FAULTS.csv.");
    if (!findings.faults.empty())
    {
      append(body.notes, findings.faults);
      const auto left = mend_surface(body, options.n_cells);
      if (!left.empty())
        throw UserError(file.string() + ": the surface does not bound a body:"
                        + list_lines(findings.faults) + "\n  and could not be repaired; left are:"
                        + list_lines(left) + "\n  Mend it in the program that made it.");
    }
    drop_unused_vertices(body.surface);
    return body;
  }
} // namespace Exemplar
