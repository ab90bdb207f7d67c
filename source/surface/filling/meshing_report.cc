// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/surface/filling/meshing_report.h>
#include <exemplar/surface/shape/vectors.h>

#include <fmt/core.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
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
  } // namespace

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
} // namespace Exemplar
