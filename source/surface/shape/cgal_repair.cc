// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/cgal_surface.h>
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/surface_repair.h>

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/version.h>

#include <cmath>

namespace Exemplar
{
  namespace PMP = CGAL::Polygon_mesh_processing;

  namespace
  {
    TriangleSurface
    from_soup(const CgalPoints &points, const CgalPolygons &polygons)
    {
      TriangleSurface surface;
      for (const CgalPoint &point : points)
        surface.vertices.push_back(from_cgal(point));
      for (const auto &p : polygons)
        surface.triangles.push_back(
            { { static_cast<unsigned int>(p[0]), static_cast<unsigned int>(p[1]),
                static_cast<unsigned int>(p[2]) } });
      surface.groups.assign(polygons.size(), 0);
      return surface;
    }

    /// Notes repairs that changed something.
    class Report
    {
    public:
      explicit Report(std::vector<std::string> &list) : lines(list) {}

      void
      add(const std::string &what, const std::size_t n)
      {
        if (n > 0)
          lines.push_back(what + ": " + std::to_string(n));
      }

    private:
      std::vector<std::string> &lines;
    };

    /// Joins vertices, turns faces, and makes edges and vertices manifold.
    CgalMesh
    make_manifold(const TriangleSurface &surface, Report &report)
    {
      CgalPoints   points;
      CgalPolygons polygons;
      to_soup(surface, points, polygons);
      PMP::repair_polygon_soup(points, polygons);
      report.add("vertices joined or left out", surface.vertices.size() - points.size());
      report.add("faces left out (without area, or twice there)",
                 surface.triangles.size() - polygons.size());
      TriangleSurface joined = from_soup(points, polygons);
      report.add("faces turned", turn_to_majority(joined).size());
      points.clear();
      polygons.clear();
      to_soup(joined, points, polygons);
      const std::size_t n_before = points.size();
      PMP::orient_polygon_soup(points, polygons);
      report.add("vertices parted where the surface touches itself", points.size() - n_before);
      CgalMesh mesh;
      PMP::polygon_soup_to_polygon_mesh(points, polygons, mesh);
      PMP::stitch_borders(mesh);
      PMP::remove_isolated_vertices(mesh);
      return mesh;
    }

    /// Fills a hole; returns the new faces.
    std::vector<CgalMesh::Face_index>
    fill_hole(CgalMesh &mesh, const CgalMesh::Halfedge_index border)
    {
      std::vector<CgalMesh::Face_index> faces;
#if CGAL_VERSION_MAJOR >= 6
      PMP::triangulate_and_refine_hole(
          mesh, border, CGAL::parameters::face_output_iterator(std::back_inserter(faces)));
#else
      std::vector<CgalMesh::Vertex_index> vertices;
      PMP::triangulate_and_refine_hole(mesh, border, std::back_inserter(faces),
                                       std::back_inserter(vertices));
#endif
      return faces;
    }

    void
    fill_holes(CgalMesh &mesh, Report &report)
    {
      std::vector<CgalMesh::Halfedge_index> borders;
      PMP::extract_boundary_cycles(mesh, std::back_inserter(borders));
      std::size_t n_filled = 0;
      for (const auto border : borders)
        n_filled += fill_hole(mesh, border).empty() ? 0 : 1;
      report.add("holes filled", n_filled);
    }

    /// Drops loose parts that are too small to be intended.
    void
    drop_small_shells(TriangleSurface &surface, Report &report)
    {
      std::vector<unsigned int> shells;
      const unsigned int        n = number_shells(surface, sorted_sides(surface), shells);
      std::vector<double>       volumes;
      for (unsigned int shell = 0; shell < n; ++shell)
        volumes.push_back(std::abs(enclosed_volume(shell_of(surface, shells, shell))));
      const double    minimum = .01 * *std::max_element(volumes.begin(), volumes.end());
      TriangleSurface kept{ surface.vertices, {}, {} };
      for (std::size_t t = 0; t < shells.size(); ++t)
        if (volumes[shells[t]] >= minimum)
        {
          kept.triangles.push_back(surface.triangles[t]);
          kept.groups.push_back(surface.groups[t]);
        }
      report.add("loose parts of less than 1 % of the volume left out",
                 static_cast<std::size_t>(std::count_if(
                     volumes.begin(), volumes.end(), [&](const double v) { return v < minimum; })));
      surface = std::move(kept);
      drop_unused_vertices(surface);
    }
  } // namespace

  RepairedSurface
  repair(const TriangleSurface &surface)
  {
    RepairedSurface result;
    Report          report(result.done);
    CgalMesh        mesh = make_manifold(surface, report);
    fill_holes(mesh, report);
    PMP::remove_degenerate_faces(mesh);
    if (CGAL::is_closed(mesh) && PMP::does_self_intersect(mesh))
    {
      const bool done = PMP::experimental::remove_self_intersections(mesh);
      report.add(done ? "regions of intersecting faces made anew" : "intersections that remain", 1);
    }
    result.surface = from_cgal_mesh(mesh, [](const CgalMesh::Face_index) { return 0U; });
    if (result.surface.triangles.empty())
      return result;
    if (CGAL::is_closed(mesh))
    {
      report.add("shells turned outwards", turn_outermost_outwards(result.surface));
      drop_small_shells(result.surface, report);
    }
    take_nearest_groups(result.surface, surface);
    return result;
  }
} // namespace Exemplar
