// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/surface/filling/body_surface.h>
#include <exemplar/surface/filling/cell_angles.h>
#include <exemplar/surface/filling/surface_meshing.h>
#include <exemplar/surface/filling/surface_msh.h>
#include <exemplar/surface/filling/surface_remeshing.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/vectors.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  double
  edge_length_of(const TriangleSurface &surface, const double n_cells)
  {
    return std::cbrt(10. * std::abs(enclosed_volume(surface)) / n_cells);
  }

  namespace
  {
    /// Quality of a mesh: angles of its cells and distances to the surface.
    struct Judgement
    {
      CellAngles      angles;
      SurfaceDistance surface_to_mesh;
      SurfaceDistance mesh_to_surface;
      double          lost = 0.; ///< largest distance of the repaired surface to the mesh
    };

    /// A mesh and its quality.
    struct JudgedMesh
    {
      TetrahedralMesh mesh;
      Judgement       judgement;
    };

    std::string
    percent(const double part, const double whole)
    {
      return short_text(100. * part / whole);
    }

    void
    add_counts(MeshingReport         &result,
               const BodySurface     &body,
               const TetrahedralMesh &mesh,
               const std::size_t      n_materials)
    {
      const auto add = [&](const std::string &what, const std::size_t n)
      { result.table.emplace_back(what, fmt::format("{}", n)); };
      add("surface_vertices", body.original.vertices.size());
      add("surface_triangles", body.original.triangles.size());
      add("nodes", mesh.nodes.size());
      add("cells", mesh.cells.size());
      add("boundary_triangles", mesh.boundary.triangles.size());
      add("boundary_ids", std::max<std::size_t>(body.group_names.size(), 1));
      add("material_ids", n_materials);
    }

    void
    add_quality(MeshingReport &result, const BodySurface &body, const JudgedMesh &judged)
    {
      const TetrahedralMesh &mesh   = judged.mesh;
      const CellAngles      &angles = judged.judgement.angles;
      const auto             add    = [&](const std::string &what, const std::string &value)
      { result.table.emplace_back(what, value); };
      add("angle_smallest", short_text(angles.smallest));
      add("angle_1_percent", short_text(angles.percentile_1));
      add("angle_median", short_text(angles.median));
      add("angle_largest", short_text(angles.largest));
      add("slivers", fmt::format("{}", angles.n_slivers));
      add("boundary_slivers", fmt::format("{}", angles.n_boundary_slivers));
      double volume = 0.;
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      {
        const auto p = corners_of(mesh, c);
        volume += six_volumes(p[0], p[1], p[2], p[3]) / 6.;
      }
      add("volume", short_text(volume));
      const double           diagonal = diagonal_of(body.original.vertices);
      const SurfaceDistance &out      = judged.judgement.surface_to_mesh;
      const SurfaceDistance &back     = judged.judgement.mesh_to_surface;
      add("diagonal", short_text(diagonal));
      add("surface_to_mesh_max", percent(out.maximum, diagonal));
      add("surface_to_mesh_mean", percent(out.mean, diagonal));
      add("mesh_to_surface_max", percent(back.maximum, diagonal));
      add("mesh_to_surface_mean", percent(back.mean, diagonal));
    }

    void
    add_notes(MeshingReport               &report,
              const SurfaceMeshingOptions &options,
              const BodySurface           &body,
              const JudgedMesh            &judged)
    {
      const std::size_t n_slivers = judged.judgement.angles.n_slivers;
      if (n_slivers > 0)
        report.notes.push_back(fmt::format("Some cells are nearly flat: {} have an angle below 3 "
                                           "degrees. More cells may help ({}).",
                                           n_slivers, options.cells_option));
      const double distance
          = 100. * judged.judgement.surface_to_mesh.maximum / diagonal_of(body.original.vertices);
      if (constexpr double tolerable = 5.; distance > tolerable)
        report.notes.push_back("Parts of the surface are " + short_text(distance)
                               + " % of its diagonal away from the mesh. More cells follow it more "
                                 "closely ("
                               + options.cells_option + ").");
      const std::size_t n_cells = judged.mesh.cells.size();
      if (std::abs(static_cast<double>(n_cells) / options.n_cells - 1.) > .1)
        report.notes.push_back(
            fmt::format("The mesh has {} cells, not {}: none nearer to it was found "
                        "that has fewer slivers and no intersections.",
                        n_cells, options.n_cells));
    }

    /// The report on a mesh for the user.
    MeshingReport
    make_report(const FillingPlace          &place,
                const BodySurface           &body,
                const JudgedMesh            &judged,
                const std::size_t            n_materials,
                const SurfaceMeshingOptions &options)
    {
      MeshingReport report{ {}, place.notes };
      report.notes.insert(report.notes.end(), body.notes.begin(), body.notes.end());
      add_counts(report, body, judged.mesh, n_materials);
      add_quality(report, body, judged);
      add_notes(report, options, body, judged);
      return report;
    }

    constexpr unsigned int n_attempts = 8;
    /// Relative error in the number of cells below which nothing more is tried.
    constexpr double near_enough = .05;

    /// Estimated number of triangles of a surface with edges of this length.
    double
    n_triangles(const TriangleSurface &surface, const double edge_length)
    {
      double area = 0.;
      for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        area += area_of(surface, t);
      return 2.3 * area / (edge_length * edge_length);
    }

    /// Refuses edges so short that remeshing would make far more triangles than the body has cells:
    /// the surface has a part that is very long and thin, whose long edges are divided.
    void
    require_few_triangles(const TriangleSurface &surface,
                          const double           edge_length,
                          const double           n_cells,
                          const std::string     &cells_option)
    {
      double longest = 0.;
      for (const auto &[a, b, c] : surface.triangles)
        longest = std::max({ longest, norm(minus(surface.vertices[a], surface.vertices[b])),
                             norm(minus(surface.vertices[b], surface.vertices[c])) });
      const double n = n_triangles(surface, edge_length) + std::pow(longest / edge_length, 2);
      if (!(n < 1e4 + 50. * n_cells))
        throw SolverFailure("The surface has a part that is very long and thin: "
                            + short_text(n_cells) + " cells are about " + short_text(edge_length)
                            + " large, and would have " + short_text(n)
                            + " triangles on it. Look for vertices far away from the others, or "
                              "ask for more cells ("
                            + cells_option + ").");
    }

    /// A surface with many times the triangles that cells of this size can follow, remeshed with
    /// edges of a part of their size, so that attempts to fill it take no longer than those of a
    /// coarse one; the surface itself if it has fewer, or cannot be remeshed without intersections.
    TriangleSurface
    without_excess(const TriangleSurface &surface,
                   const double           n_cells,
                   const std::string     &cells_option)
    {
      constexpr double part = .4, many = 2.;
      const double     edge_length = part * edge_length_of(surface, n_cells);
      if (static_cast<double>(surface.triangles.size()) < many * n_triangles(surface, edge_length))
        return surface;
      try
      {
        require_few_triangles(surface, edge_length, n_cells, cells_option);
        const std::vector<OpenGap> no_gaps;
        return SheetRemeshing(surface, true, NearSheets::held, no_gaps, cells_option)
            .remesh(edge_length);
      }
      catch (const SolverFailure &)
      {
        return surface;
      }
    }

    struct FilledSurface
    {
      TetrahedralMesh mesh;
      bool            has_near_sheets = false; ///< whether sheets intersected in some attempt
    };

    /// The mesh with the number of cells nearest to the one wanted: n ~ h^-p with p from the last
    /// two attempts.
    FilledSurface
    fill_with(const TriangleSurface       &surface,
              const double                 n_cells,
              const bool                   keep_edges,
              const NearSheets             near_sheets,
              const std::vector<OpenGap>  &gaps,
              const SurfaceMeshingOptions &options)
    {
      SheetRemeshing remeshing(surface, keep_edges, near_sheets, gaps, options.cells_option);
      double         h     = edge_length_of(surface, n_cells);
      double         power = 3., last_h = 0., last_n = 0., best_error = 0.;
      FilledSurface  best;
      for (unsigned int attempt = 0; attempt < n_attempts; ++attempt)
      {
        TetrahedralMesh mesh;
        options.tell(MeshingStage::filling);
        try
        {
          require_few_triangles(surface, h, n_cells, options.cells_option);
          mesh = fill(remeshing.remesh(h));
        }
        catch (const SolverFailure &)
        {
          if (best.mesh.cells.empty() && attempt + 1 == n_attempts)
            throw;
          h *= .9; // finer surfaces are filled more easily
          continue;
        }
        const auto   n     = static_cast<double>(mesh.cells.size());
        const double error = std::abs(std::log(n / n_cells));
        if (last_n > 0. && std::abs(std::log(h / last_h)) > 1e-3)
          power = std::clamp(std::log(n / last_n) / std::log(last_h / h), 1.5, 4.);
        if (best.mesh.cells.empty() || error < best_error)
        {
          best.mesh  = std::move(mesh);
          best_error = error;
        }
        if (error < near_enough)
          break;
        last_h = h;
        last_n = n;
        h = std::min(h * std::pow(n / n_cells, 1. / power), .5 * diagonal_of(surface.vertices));
        if (h == last_h)
          break; // no better edge length
      }
      best.has_near_sheets = remeshing.has_near_sheets();
      return best;
    }

    Judgement
    judge(const BodySurface &body, const TetrahedralMesh &mesh)
    {
      TriangleSurface boundary = mesh.boundary;
      boundary.vertices        = mesh.nodes;
      const NearestTriangle to_mesh(boundary);
      return { measure_angles(mesh), distance_to(to_mesh, body.original),
               distance_to(NearestTriangle(body.original), boundary),
               distance_to(to_mesh, body.surface).maximum };
    }

    /// Whether a mesh takes the place of the best one so far: with fewer slivers, and the surface
    /// at most half as far away again.
    bool
    is_better(const Judgement &now, const JudgedMesh &best)
    {
      return best.mesh.cells.empty()
             || (now.angles.n_slivers < best.judgement.angles.n_slivers
                 && now.lost < 1.5 * best.judgement.lost);
    }

    /// The first mesh without slivers, or the one with the fewest, from a few ways of remeshing:
    /// with the sharp edges of the surface kept, or not, where they may be noise, and with near
    /// sheets held, or refined. Throws SolverFailure if none gives a mesh.
    JudgedMesh
    best_of_ways(const BodySurface           &body,
                 const TriangleSurface       &surface,
                 const double                 n_cells,
                 const std::vector<OpenGap>  &gaps,
                 const SurfaceMeshingOptions &options,
                 JudgedMesh                   best)
    {
      const bool        is_sharp = has_sharp_edges(surface, .5 * edge_length_of(surface, n_cells));
      std::vector<bool> keeping{ true };
      if (is_sharp)
        keeping.push_back(false); // otherwise it gives the same
      for (const bool keep_edges : keeping)
        for (const NearSheets near_sheets : { NearSheets::held, NearSheets::refined })
          try
          {
            FilledSurface filled
                = fill_with(surface, n_cells, keep_edges, near_sheets, gaps, options);
            remove_slivers(filled.mesh, BoundaryNodes::kept);
            const Judgement now = judge(body, filled.mesh);
            if (is_better(now, best))
              best = { std::move(filled.mesh), now };
            if (best.judgement.angles.n_slivers == 0)
              return best;
            if (!filled.has_near_sheets || !gaps.empty())
              break; // the other treatment would give the same, or no better gaps
          }
          catch (const SolverFailure &)
          {
            if (keep_edges == keeping.back() && near_sheets == NearSheets::refined
                && best.mesh.cells.empty())
              throw;
          }
      return best;
    }

    /// The best mesh; for few cells, where slivers may go with the number of cells, other numbers
    /// are tried, too.
    JudgedMesh
    best_mesh(const BodySurface           &body,
              const std::vector<OpenGap>  &gaps,
              const SurfaceMeshingOptions &options)
    {
      constexpr std::size_t few = 1000, quickly_remeshed = 20000;
      options.tell(MeshingStage::thinning);
      const TriangleSurface surface
          = without_excess(body.surface, options.n_cells, options.cells_option);
      const bool is_quick = options.n_cells <= few && surface.triangles.size() <= quickly_remeshed;
      JudgedMesh best;
      for (const double factor : { 1., 1.07, .93, 1.14, .88 })
        if (factor == 1. || (is_quick && best.judgement.angles.n_slivers > 0))
          best = best_of_ways(body, surface, factor * options.n_cells, gaps, options,
                              std::move(best));
      if (best.judgement.angles.n_slivers > 0)
      {
        remove_slivers(best.mesh, BoundaryNodes::moved_slightly);
        best.judgement = judge(body, best.mesh);
      }
      return best;
    }
  } // namespace

  MeshedSurface
  mesh_surface(const SurfaceMeshingOptions &options)
  {
    const SurfaceMesh read = read_surface(options.surface);
    return mesh_surface_at(read, { read.vertices, {}, {}, {} }, options);
  }

  MeshedSurface
  mesh_surface_at(const SurfaceMesh           &rest,
                  const FillingPlace          &place,
                  const SurfaceMeshingOptions &options)
  {
    std::vector<MaterialSeed> seeds;
    if (!options.materials.empty())
      seeds = read_material_seeds(options.materials);
    SurfaceMesh placed = rest;
    placed.vertices    = place.vertices;
    BodySurface body   = make_body_surface(placed, options);
    JudgedMesh  judged = best_mesh(body, place.gaps, options);
    options.tell(MeshingStage::measuring);
    if (place.carry_back)
    {
      place.carry_back(judged.mesh);
      body.original    = triangulate(rest);
      judged.judgement = judge(body, judged.mesh);
    }
    const auto      regions = names_of_regions(judged.mesh, body.group_names);
    const Materials materials
        = seeds.empty() ? materials_by_regions(judged.mesh, regions)
                        : materials_by_seeds(judged.mesh, seeds, regions, options.materials);
    return { make_surface_msh(judged.mesh, body.group_names, materials),
             make_report(place, body, judged, materials.names.size(), options) };
  }
} // namespace Exemplar
