// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/filling/surface_remeshing.h>
#include <exemplar/surface/shape/cgal_surface.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/vectors.h>

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace Exemplar
{
  namespace PMP = CGAL::Polygon_mesh_processing;

  namespace
  {
    constexpr double sharp_angle = 60.; // degrees
    constexpr double min_chain   = 5.;  // edge lengths
    constexpr double max_crowd
        = 7.; // edge lengths in a cube of that side; corners of solids have 3
    constexpr unsigned int n_iterations = 5;
    constexpr double       tip_spacing  = .5; // edge lengths

    using Groups = CgalMesh::Property_map<CgalMesh::Face_index, unsigned int>;
    using Kept   = CgalMesh::Property_map<CgalMesh::Edge_index, bool>;

    double
    length_of(const CgalMesh &mesh, const CgalMesh::Edge_index edge)
    {
      return norm(minus(from_cgal(mesh.point(mesh.vertex(edge, 0))),
                        from_cgal(mesh.point(mesh.vertex(edge, 1)))));
    }

    /// Releases kept edges where many are nearer to each other than the new edges are long: no
    /// triangles of that size fit between them, and those that had to follow all of them would
    /// intersect.
    void
    drop_crowded_edges(const CgalMesh &mesh, const double edge_length, Kept &kept)
    {
      const auto cube_of = [&](const CgalMesh::Edge_index edge)
      {
        const auto            a = from_cgal(mesh.point(mesh.vertex(edge, 0)));
        const auto            b = from_cgal(mesh.point(mesh.vertex(edge, 1)));
        std::array<double, 3> cube{};
        for (unsigned int i = 0; i < 3; ++i)
          cube[i] = std::floor(.5 * (a[i] + b[i]) / edge_length);
        return cube;
      };
      std::map<std::array<double, 3>, double> lengths;
      for (const auto edge : mesh.edges())
        if (kept[edge])
          lengths[cube_of(edge)] += std::min(length_of(mesh, edge), edge_length);
      for (const auto edge : mesh.edges())
        if (kept[edge] && lengths[cube_of(edge)] > max_crowd * edge_length)
          kept[edge] = false;
    }

    /// Keeps sharp edges that form chains of at least min_chain edge lengths.
    void
    keep_sharp_edges(const CgalMesh &mesh, const double edge_length, Kept &kept)
    {
      PMP::detect_sharp_edges(mesh, sharp_angle, kept);
      drop_crowded_edges(mesh, edge_length, kept);
      UnionFind chains(mesh.number_of_vertices());
      for (const auto edge : mesh.edges())
        if (kept[edge])
          chains.join(mesh.vertex(edge, 0), mesh.vertex(edge, 1));
      std::vector<double> lengths(mesh.number_of_vertices(), 0.);
      for (const auto edge : mesh.edges())
        if (kept[edge])
          lengths[chains.root(mesh.vertex(edge, 0))] += length_of(mesh, edge);
      for (const auto edge : mesh.edges())
        if (kept[edge] && lengths[chains.root(mesh.vertex(edge, 0))] < min_chain * edge_length)
          kept[edge] = false;
    }

    void
    keep_borders(const CgalMesh &mesh, const Groups &groups, Kept &kept)
    {
      for (const auto edge : mesh.edges())
      {
        const auto halfedge = mesh.halfedge(edge);
        if (groups[mesh.face(halfedge)] != groups[mesh.face(mesh.opposite(halfedge))])
          kept[edge] = true;
      }
    }
    /// Insert a vertex in the edge of `halfedge`, which then begins there; faces stay triangles.
    void
    split(CgalMesh                      &mesh,
          const CgalMesh::Halfedge_index halfedge,
          const SurfaceMesh::Vertex     &place,
          Groups                        &groups,
          Kept                          &kept)
    {
      const auto group                = groups[mesh.face(halfedge)];
      const auto other_group          = groups[mesh.face(mesh.opposite(halfedge))];
      const auto before               = CGAL::Euler::split_edge(halfedge, mesh);
      mesh.point(mesh.target(before)) = to_cgal(place);
      kept[mesh.edge(before)]         = true;
      const auto cut                  = CGAL::Euler::split_face(before, mesh.next(halfedge), mesh);
      const auto other                = CGAL::Euler::split_face(mesh.opposite(halfedge),
                                                                mesh.next(mesh.opposite(before)), mesh);
      for (const auto side : { cut, mesh.opposite(cut) })
        groups[mesh.face(side)] = group;
      for (const auto side : { other, mesh.opposite(other) })
        groups[mesh.face(side)] = other_group;
    }

    /// Divide long kept edges evenly: halved again and again, as the remeshing would, only edges of
    /// certain lengths could come out, and only certain numbers of cells.
    void
    divide_kept_edges(CgalMesh &mesh, const double edge_length, Groups &groups, Kept &kept)
    {
      std::vector<CgalMesh::Edge_index> edges;
      for (const auto edge : mesh.edges())
        if (kept[edge] && length_of(mesh, edge) > 4. / 3. * edge_length)
          edges.push_back(edge);
      for (const auto edge : edges)
      {
        const auto                halfedge = mesh.halfedge(edge);
        const SurfaceMesh::Vertex from     = from_cgal(mesh.point(mesh.source(halfedge)));
        const SurfaceMesh::Vertex to       = from_cgal(mesh.point(mesh.target(halfedge)));
        const double              n        = std::round(length_of(mesh, edge) / edge_length);
        for (double i = 1.; i < n; i += 1.)
          split(mesh, halfedge, plus(from, i / n, minus(to, from)), groups, kept);
      }
    }

    /// Vertices and triangles that remeshing leaves alone.
    struct Held
    {
      std::vector<bool> vertices;
      std::vector<bool> triangles; ///< none: no triangle
    };

    /// A vertex map of the held vertices of a surface, of which the mesh is a copy.
    auto
    map_of_held(const Held &held, CgalMesh &mesh)
    {
      auto map = mesh.add_property_map<CgalMesh::Vertex_index, bool>("v:held", false).first;
      for (std::size_t i = 0; i < held.vertices.size(); ++i)
        map[CgalMesh::Vertex_index(static_cast<unsigned int>(i))] = held.vertices[i];
      return map;
    }

    std::vector<CgalMesh::Face_index>
    faces_to_change(const Held &held, const CgalMesh &mesh)
    {
      std::vector<CgalMesh::Face_index> faces;
      for (const auto face : mesh.faces())
        if (face >= held.triangles.size() || !held.triangles[face])
          faces.push_back(face);
      return faces;
    }

    TriangleSurface
    remesh_holding(const TriangleSurface &surface,
                   const double           edge_length,
                   const bool             keep_edges,
                   const Held            &held)
    {
      CgalMesh mesh = make_cgal_mesh(surface);
      Groups   groups
          = mesh.add_property_map<CgalMesh::Face_index, unsigned int>("f:group", 0U).first;
      for (const auto face : mesh.faces())
        groups[face] = surface.groups[face];
      Kept kept = mesh.add_property_map<CgalMesh::Edge_index, bool>("e:kept", false).first;
      if (keep_edges)
        keep_sharp_edges(mesh, edge_length, kept);
      keep_borders(mesh, groups, kept);
      if (held.triangles.empty())
        divide_kept_edges(mesh, edge_length, groups, kept);
      PMP::isotropic_remeshing(faces_to_change(held, mesh), edge_length, mesh,
                               PMP::parameters::number_of_iterations(n_iterations)
                                   .number_of_relaxation_steps(3)
                                   .edge_is_constrained_map(kept)
                                   .vertex_is_constrained_map(map_of_held(held, mesh))
                                   .face_patch_map(groups));
      return from_cgal_mesh(mesh, [&](const CgalMesh::Face_index face) { return groups[face]; });
    }

    /// Vertices farther from a remeshed surface than half of `spacing`, chosen from the farthest on
    /// and no two nearer than `spacing`: the tips of ears and tails, which relaxation rounds off.
    std::vector<bool>
    lost_tips(const TriangleSurface &surface, const TriangleSurface &remeshed, const double spacing)
    {
      const NearestTriangle                        nearest(remeshed);
      std::vector<std::pair<double, unsigned int>> far;
      for (unsigned int i = 0; i < surface.vertices.size(); ++i)
        if (const double distance = nearest(surface.vertices[i]).first; distance > .5 * spacing)
          far.emplace_back(-distance, i);
      std::sort(far.begin(), far.end());
      std::vector<bool>         is_tip(surface.vertices.size(), false);
      std::vector<unsigned int> tips;
      for (const auto &[minus_distance, i] : far)
        if (std::all_of(tips.begin(), tips.end(),
                        [&, vertex = i](const unsigned int tip) {
                          return norm(minus(surface.vertices[vertex], surface.vertices[tip]))
                                 > spacing;
                        }))
        {
          tips.push_back(i);
          is_tip[i] = true;
        }
      return is_tip;
    }
  } // namespace

  TriangleSurface
  thin(const TriangleSurface &surface, const double edge_length, std::vector<Treatment> &treatments)
  {
    // borders of groups stay: each treatment gets groups of its own
    const unsigned int n_groups
        = 1 + *std::max_element(surface.groups.begin(), surface.groups.end());
    TriangleSurface   marked = surface;
    std::vector<bool> others(treatments.size());
    for (std::size_t t = 0; t < treatments.size(); ++t)
    {
      marked.groups[t] += static_cast<unsigned int>(treatments[t]) * n_groups;
      others[t] = treatments[t] != Treatment::thinned;
    }
    TriangleSurface result = remesh_holding(
        marked, edge_length, false, { std::vector<bool>(surface.vertices.size(), false), others });
    treatments.clear();
    for (unsigned int &group : result.groups)
    {
      treatments.push_back(static_cast<Treatment>(group / n_groups));
      group %= n_groups;
    }
    return result;
  }

  bool
  has_sharp_edges(const TriangleSurface &surface, const double edge_length)
  {
    CgalMesh   mesh = make_cgal_mesh(surface);
    const Kept kept = mesh.add_property_map<CgalMesh::Edge_index, bool>("e:kept", false).first;
    for (const double length : { edge_length, 2. * edge_length })
    {
      Kept now = kept;
      keep_sharp_edges(mesh, length, now);
      for (const auto edge : mesh.edges())
        if (now[edge])
          return true;
    }
    return false;
  }

  TriangleSurface
  remesh(const TriangleSurface   &surface,
         const double             edge_length,
         const bool               keep_edges,
         const std::vector<bool> &held)
  {
    const std::vector<bool> none(surface.vertices.size(), false);
    TriangleSurface result = remesh_holding(surface, edge_length, keep_edges, { none, held });
    const auto      tips   = lost_tips(surface, result, tip_spacing * edge_length);
    return tips == none ? result : remesh_holding(surface, edge_length, keep_edges, { tips, held });
  }
} // namespace Exemplar
