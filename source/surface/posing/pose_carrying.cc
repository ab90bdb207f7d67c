// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/surface/posing/pose_carrying.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/surface_poses.h>
#include <exemplar/surface/shape/vectors.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    using Points = PoseTransfer::Points;

    double
    diagonal(const Points &points)
    {
      dealii::Point<3> low = points.front(), high = low;
      for (const auto &x : points)
        for (int d = 0; d < 3; ++d)
        {
          low[d]  = std::min(low[d], x[d]);
          high[d] = std::max(high[d], x[d]);
        }
      return low.distance(high);
    }

    RigidMotion
    inverse(const RigidMotion &motion)
    {
      return { motion.to, motion.from,
               transpose_times(motion.rotation, identity_matrix<double>()) };
    }

    Points
    moved(const RigidMotion &motion, Points points)
    {
      for (auto &x : points)
        x = motion(x);
      return points;
    }

    /// The part of the area that belongs to each vertex.
    std::vector<double>
    areas_of_vertices(const TriangleSurface &surface)
    {
      std::vector<double> result(surface.vertices.size(), 0.);
      for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        for (const unsigned int v : surface.triangles[t])
          result[v] += area_of(surface, t) / 3.;
      return result;
    }

    Points
    selected(const Points &points, const std::vector<unsigned int> &which)
    {
      Points result;
      for (const unsigned int i : which)
        result.push_back(points[i]);
      return result;
    }

    SurfaceMesh
    read_checked(const std::filesystem::path &file)
    {
      SurfaceMesh surface = read_surface(file);
      require_surface(surface, file.string());
      return surface;
    }
  } // namespace

  PoseTransfer::Points
  as_points(const SurfaceAttachment::Vertices &vertices)
  {
    Points result;
    for (const auto &x : vertices)
      result.emplace_back(x[0], x[1], x[2]);
    return result;
  }

  PoseTransfer::PoseTransfer(const Points               &nodes,
                             const FoldPotential::Cells &cells,
                             SurfaceAttachment           of_boundary,
                             const double                attach,
                             const unsigned int          n_threads)
      : nodes(nodes), attachment(std::move(of_boundary)),
        potential(std::make_unique<FoldPotential>(nodes, cells, n_threads)), solver(*potential)
  {
    // volume / area is half the radius of a limb; the body's dimensionless moduli are 2 to 4.5
    const auto  &areas  = attachment.get_areas();
    const double area   = std::accumulate(areas.begin(), areas.end(), 0.);
    const double length = potential->get_volume() / area;
    for (const double of_node : areas)
      stiffness.push_back(attach * 3. * of_node / area / (length * length));
  }

  void
  PoseTransfer::attach_to(const Points &targets)
  {
    const auto &which = attachment.get_nodes();
    for (std::size_t k = 0; k < which.size(); ++k)
    {
      potential->attachment.target[which[k]]    = targets[k];
      potential->attachment.stiffness[which[k]] = stiffness[k];
    }
  }

  Points
  PoseTransfer::carry(const SurfaceAttachment::Vertices &vertices, PoseQuality &quality)
  {
    const Points      targets = attachment.targets(vertices);
    const RigidMotion motion  = best_rigid_motion(selected(nodes, attachment.get_nodes()), targets);
    attach_to(moved(inverse(motion), targets));
    FoldSolver::Result result = solver.solve(nodes);
    if (skin != nullptr)
      draw_skin_nearer(result, moved(inverse(motion), as_points(vertices)));

    quality            = {};
    quality.rotation   = axis_and_angle(motion.rotation).angle * 180. / M_PI;
    quality.shift      = motion.from.distance(motion.to);
    quality.iterations = result.iterations;
    quality.releases   = result.releases;
    const Points x     = moved(motion, result.x);
    measure(x, quality);
    if (skin != nullptr)
    {
      measure_surface(x, vertices, quality);
      measure_motion(moved(inverse(motion), as_points(vertices)), quality);
    }
    else
      measure_boundary(x, targets, quality);
    return x;
  }

  void
  PoseTransfer::tell_steps(const std::function<void(unsigned int)> &tell)
  {
    solver.tell = tell;
  }

  void
  PoseTransfer::draw_skin_nearer(FoldSolver::Result &result, const Points &places)
  {
    potential->skin = SkinSprings(*skin, measured, nodes, places);
    solver.draw_nearer(result, skin_stiffness);
    potential->skin = {};
  }

  void
  PoseTransfer::follow_skin(const SurfaceMesh &rest, const Mesh &mesh)
  {
    skin = std::make_unique<SurfaceSkin>(rest, mesh);
    measured.clear();
    edges.clear();
    for (const auto &face : rest.faces)
    {
      measured.insert(measured.end(), face.begin(), face.end());
      for (std::size_t i = 0; i < face.size(); ++i)
        edges.push_back({ { face[i], face[(i + 1) % face.size()] } });
    }
    std::sort(measured.begin(), measured.end());
    measured.erase(std::unique(measured.begin(), measured.end()), measured.end());

    const std::vector<double> areas    = areas_of_vertices(triangulate(rest));
    const double              whole    = std::accumulate(areas.begin(), areas.end(), 0.);
    const double              strength = std::accumulate(stiffness.begin(), stiffness.end(), 0.);
    skin_stiffness.clear();
    for (const std::size_t v : measured)
      skin_stiffness.push_back(strength * areas[v] / whole);
  }

  void
  PoseTransfer::measure(const Points &x, PoseQuality &quality) const
  {
    const auto         &cells = potential->get_cells();
    std::vector<double> stretches;
    quality.min_det = std::numeric_limits<double>::infinity();
    quality.max_det = -quality.min_det;
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      const Matrix3<double> F   = potential->gradient_of_cell(x, c);
      const double          det = determinant(F);
      quality.n_inverted += det > 0. ? 0 : 1;
      quality.min_det    = std::min(quality.min_det, det);
      quality.max_det    = std::max(quality.max_det, det);
      const auto squares = symmetric_eigensystem(transpose_times(F, F)).values;
      for (int d = 0; d < 3; ++d)
        stretches.push_back(std::sqrt(std::max(0., squares[d])));
    }
    std::sort(stretches.begin(), stretches.end());
    const auto quantile = [&](const double share)
    { return stretches[static_cast<std::size_t>(share * (stretches.size() - 1) + 0.5)]; };
    quality.min_stretch = stretches.front();
    quality.stretch_1   = quantile(0.01);
    quality.stretch_99  = quantile(0.99);
    quality.max_stretch = stretches.back();
  }

  void
  PoseTransfer::measure_boundary(const Points &x, const Points &targets, PoseQuality &quality) const
  {
    const auto  &which = attachment.get_nodes();
    const double size  = diagonal(nodes);
    for (std::size_t k = 0; k < which.size(); ++k)
    {
      const double error = x[which[k]].distance(targets[k]) / size;
      quality.mean_error += error / which.size();
      quality.max_error = std::max(quality.max_error, error);
    }
  }

  void
  PoseTransfer::measure_surface(const Points                      &x,
                                const SurfaceAttachment::Vertices &vertices,
                                PoseQuality                       &quality) const
  {
    Vector displacement(3 * nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        displacement[3 * i + c] = x[i][c] - nodes[i][c];
    const auto   places = skin->carry(displacement);
    const double size   = diagonal(nodes);
    for (const std::size_t v : measured)
    {
      const double error = norm(minus(places[v], vertices[v])) / size;
      quality.mean_error += error / static_cast<double>(measured.size());
      if (error > quality.max_error)
      {
        quality.max_error    = error;
        quality.vertex       = v + 1;
        quality.vertex_place = vertices[v];
      }
    }
    for (const auto &[a, b] : edges)
      if (const double own = norm(minus(vertices[a], vertices[b])); own > 0.)
        if (const double ratio = norm(minus(places[a], places[b])) / own;
            ratio > quality.longest_edge)
        {
          quality.longest_edge = ratio;
          quality.edge_at_rest = skin->place_at_rest(a).distance(skin->place_at_rest(b)) / own;
          quality.edge         = { { a + 1U, b + 1U } };
          quality.edge_place   = plus(vertices[a], .5, minus(vertices[b], vertices[a]));
        }
  }

  void
  PoseTransfer::measure_motion(const Points &unmoved, PoseQuality &quality) const
  {
    const double size = diagonal(nodes);
    for (const std::size_t v : measured)
      quality.motion = std::max(quality.motion, unmoved[v].distance(skin->place_at_rest(v)) / size);
  }

  RestSurface::RestSurface(const std::filesystem::path &file)
      : name(file.string()), surface(read_checked(file))
  {
  }

  SurfaceMesh
  read_pose_surface(const std::filesystem::path &file, const RestSurface &rest)
  {
    SurfaceMesh pose = read_checked(file);
    check_same_order(rest.surface, rest.name, pose, file.string());
    check_pose(rest.surface, rest.name, pose, file.string());
    return pose;
  }

  PoseTransfer
  make_pose_transfer(const Mesh        &mesh,
                     const RestSurface &rest,
                     const double       attach,
                     const unsigned int n_threads)
  {
    const SurfaceAttachment attachment(mesh.get_nodes(), mesh.get_boundary_faces(),
                                       triangulate(rest.surface));
    check_attachment(attachment, mesh, rest.name);
    PoseTransfer transfer(mesh.get_nodes(), mesh.get_cells(), attachment, attach, n_threads);
    transfer.follow_skin(rest.surface, mesh);
    return transfer;
  }

  bool
  is_surface_of(const Mesh &mesh, const SurfaceMesh &surface)
  {
    try
    {
      check_attachment({ mesh.get_nodes(), mesh.get_boundary_faces(), triangulate(surface) }, mesh,
                       "");
      return true;
    }
    catch (const UserError &)
    {
      return false;
    }
  }

  std::string
  inverted_elements(const PoseTransfer                  &transfer,
                    const Mesh                          &mesh,
                    const std::vector<dealii::Point<3>> &x)
  {
    const std::vector<double> determinants = transfer.determinants(x);
    std::vector<std::size_t>  numbers;
    for (unsigned int c = 0; c < determinants.size(); ++c)
      if (!(determinants[c] > FoldSolver::margin))
        numbers.push_back(mesh.element_number(c));
    return numbers.empty() ? "" : list_numbers(numbers);
  }
} // namespace Exemplar
