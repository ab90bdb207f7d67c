// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/surface/body_surface.h>
#include <exemplar/surface/cell_angles.h>
#include <exemplar/surface/surface_geometry.h>
#include <exemplar/surface/surface_meshing.h>
#include <exemplar/surface/surface_remeshing.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int n_attempts = 8;
    /// Nearer to the wanted number of cells than this, nothing more is tried.
    constexpr double near_enough = .05;

    /// Edges as long as wanted, shorter where the surface would else intersect itself.
    TriangleSurface
    remesh_without_intersections(const TriangleSurface &surface,
                                 const double           edge_length,
                                 const bool             keep_edges,
                                 const std::string     &cells_option)
    {
      for (const double factor : { 1., .8, .64, .5, .3 })
      {
        TriangleSurface result = remesh(surface, factor * edge_length, keep_edges);
        if (check_surface({ result, {} }).faults.empty())
          return result;
      }
      throw SolverFailure("The surface intersects itself when its edges become "
                          + short_text(edge_length) + " long. Ask for more cells (" + cells_option
                          + "), or thicken its thin parts.");
    }

    /// The mesh with the number of cells nearest to the one wanted: n ~ h^-p with p from the last
    /// two attempts.
    TetrahedralMesh
    fill_with(const TriangleSurface       &surface,
              const SurfaceMeshingOptions &options,
              const bool                   keep_edges)
    {
      const double n_cells = options.n_cells;
      // a cell in gmsh's meshes has about a tenth of its edge's cube
      double          h     = std::cbrt(10. * std::abs(enclosed_volume(surface)) / n_cells);
      double          power = 3., last_h = 0., last_n = 0., best_error = 0.;
      TetrahedralMesh best;
      for (unsigned int attempt = 0; attempt < n_attempts; ++attempt)
      {
        TetrahedralMesh mesh;
        try
        {
          mesh = fill(remesh_without_intersections(surface, h, keep_edges, options.cells_option));
        }
        catch (const SolverFailure &)
        {
          if (best.cells.empty() && attempt + 1 == n_attempts)
            throw;
          h *= .9; // finer surfaces are filled more easily
          continue;
        }
        const auto   n     = static_cast<double>(mesh.cells.size());
        const double error = std::abs(std::log(n / n_cells));
        if (last_n > 0. && std::abs(std::log(h / last_h)) > 1e-3)
          power = std::clamp(std::log(n / last_n) / std::log(last_h / h), 1.5, 4.);
        if (best.cells.empty() || error < best_error)
        {
          best       = std::move(mesh);
          best_error = error;
        }
        if (error < near_enough)
          break;
        last_h = h;
        last_n = n;
        h *= std::pow(n / n_cells, 1. / power);
      }
      return best;
    }

    /// What a mesh is judged by.
    struct Judgement
    {
      CellAngles      angles;
      SurfaceDistance surface_to_mesh;
      SurfaceDistance mesh_to_surface;
      double          lost = 0.; ///< the farthest that a point of the mended surface is off
    };

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

    struct JudgedMesh
    {
      TetrahedralMesh mesh;
      Judgement       judgement;
    };

    /// With the sharp edges of the surface kept; without them where they are noise: where that
    /// avoids slivers, or intersections, and moves the surface at most half as far again.
    JudgedMesh
    best_mesh(const BodySurface &body, const SurfaceMeshingOptions &options)
    {
      JudgedMesh best;
      for (const bool keep_edges : { true, false })
        try
        {
          TetrahedralMesh mesh = fill_with(body.surface, options, keep_edges);
          remove_slivers(mesh);
          const Judgement now = judge(body, mesh);
          if (best.mesh.cells.empty()
              || (now.angles.n_slivers < best.judgement.angles.n_slivers
                  && now.lost < 1.5 * best.judgement.lost))
            best = { std::move(mesh), now };
          if (best.judgement.angles.n_slivers == 0)
            break;
        }
        catch (const SolverFailure &)
        {
          if (!keep_edges && best.mesh.cells.empty())
            throw;
        }
      return best;
    }

    /// Names that are all whole numbers are ids; others get theirs in order, from 1.
    std::vector<unsigned int>
    ids_of(const std::vector<std::string> &names)
    {
      std::vector<unsigned int> ids, in_order;
      for (const std::string &name : names)
      {
        unsigned int id  = 0;
        const char  *end = name.data() + name.size();
        in_order.push_back(static_cast<unsigned int>(in_order.size() + 1));
        const auto done = std::from_chars(name.data(), end, id);
        if (done.ec == std::errc() && done.ptr == end && id < 2000000000U)
          ids.push_back(id);
      }
      const std::set<unsigned int> distinct(ids.begin(), ids.end());
      return distinct.size() == names.size() ? ids : in_order;
    }

    /// Whether each triangle of the boundary has cells on one side only: others lie between regions.
    std::vector<bool>
    outer_triangles(const TetrahedralMesh &mesh)
    {
      using Triangle    = std::array<unsigned int, 3>;
      const auto sorted = [](Triangle t)
      {
        std::sort(t.begin(), t.end());
        return t;
      };
      std::map<Triangle, unsigned int> n_cells;
      for (const Triangle &t : mesh.boundary.triangles)
        n_cells[sorted(t)] = 0;
      for (const auto &c : mesh.cells)
        for (unsigned int k = 0; k < 4; ++k)
        {
          const auto found
              = n_cells.find(sorted({ { c[(k + 1) % 4], c[(k + 2) % 4], c[(k + 3) % 4] } }));
          if (found != n_cells.end())
            ++found->second;
        }
      std::vector<bool> outer;
      for (const Triangle &t : mesh.boundary.triangles)
        outer.push_back(n_cells[sorted(t)] == 1);
      return outer;
    }

    MshFile
    make_msh_of(const TetrahedralMesh &mesh, const std::vector<std::string> &group_names)
    {
      const auto names = group_names.empty() ? std::vector<std::string>{ "surface" } : group_names;
      const auto ids   = ids_of(names);
      std::vector<dealii::Point<3>> nodes;
      for (const auto &node : mesh.nodes)
        nodes.emplace_back(node[0], node[1], node[2]);
      std::vector<unsigned int> materials;
      for (const unsigned int region : mesh.regions)
        materials.push_back(region + 1);
      std::vector<BoundaryFace> faces;
      const std::vector<bool>   outer = outer_triangles(mesh);
      for (std::size_t t = 0; t < mesh.boundary.triangles.size(); ++t)
        if (outer[t])
          faces.push_back({ mesh.boundary.triangles[t], ids[mesh.boundary.groups[t]] });
      MshFile msh = make_msh(std::move(nodes), mesh.cells, materials, faces);
      for (std::size_t i = 0; i < names.size(); ++i)
        if (ids[i] > 0 && !names[i].empty())
          msh.physical_names[{ 2, static_cast<int>(ids[i]) }] = names[i];
      for (const unsigned int material : std::set<unsigned int>(materials.begin(), materials.end()))
        msh.physical_names[{ 3, static_cast<int>(material) }]
            = materials.back() == 1 ? "body" : "shell " + std::to_string(material);
      return msh;
    }

    std::string
    percent(const double part, const double whole)
    {
      return short_text(100. * part / whole);
    }

    void
    add_counts(MeshingReport &result, const BodySurface &body, const TetrahedralMesh &mesh)
    {
      const auto add = [&](const std::string &what, const std::size_t n)
      { result.table.emplace_back(what, std::to_string(n)); };
      add("surface_vertices", body.original.vertices.size());
      add("surface_triangles", body.original.triangles.size());
      add("nodes", mesh.nodes.size());
      add("cells", mesh.cells.size());
      add("boundary_triangles", mesh.boundary.triangles.size());
      add("boundary_ids", std::max<std::size_t>(body.group_names.size(), 1));
      add("material_ids", 1 + *std::max_element(mesh.regions.begin(), mesh.regions.end()));
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
      add("slivers", std::to_string(angles.n_slivers));
      add("boundary_slivers", std::to_string(angles.n_boundary_slivers));
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
    add_notes(MeshingReport &report, const SurfaceMeshingOptions &options, const JudgedMesh &judged)
    {
      const std::size_t n_slivers = judged.judgement.angles.n_slivers;
      if (n_slivers > 0)
        report.notes.push_back("Some cells are nearly flat: " + std::to_string(n_slivers)
                               + " have an angle below 3 degrees. More cells may help ("
                               + options.cells_option + ").");
      const std::size_t n_cells = judged.mesh.cells.size();
      if (std::abs(static_cast<double>(n_cells) / options.n_cells - 1.) > .1)
        report.notes.push_back("The mesh has " + std::to_string(n_cells) + " cells, not "
                               + std::to_string(options.n_cells)
                               + ": its shape allows no number nearer to it.");
    }
  } // namespace

  MeshedSurface
  mesh_surface(const SurfaceMeshingOptions &options)
  {
    const BodySurface body   = read_body_surface(options);
    const JudgedMesh  judged = best_mesh(body, options);
    MeshedSurface     result;
    result.mesh           = make_msh_of(judged.mesh, body.group_names);
    MeshingReport &report = result.report;
    report.notes          = body.notes;
    add_counts(report, body, judged.mesh);
    add_quality(report, body, judged);
    add_notes(report, options, judged);
    return result;
  }
} // namespace Exemplar
