// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/cgal_surface.h>
#include <exemplar/surface/surface_edges.h>
#include <exemplar/surface/surface_geometry.h>
#include <exemplar/surface/surface_remeshing.h>
#include <exemplar/surface/vectors.h>

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

namespace Exemplar
{
  namespace PMP = CGAL::Polygon_mesh_processing;

  namespace
  {
    constexpr double       sharp_angle  = 60.; // degrees
    constexpr double       least_chain  = 5.;  // edge lengths
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

    /// Sharp edges that hang together over a length that is seen.
    void
    keep_sharp_edges(const CgalMesh &mesh, const double edge_length, Kept &kept)
    {
      PMP::detect_sharp_edges(mesh, sharp_angle, kept);
      UnionFind chains(mesh.number_of_vertices());
      for (const auto edge : mesh.edges())
        if (kept[edge])
          chains.join(mesh.vertex(edge, 0), mesh.vertex(edge, 1));
      std::vector<double> lengths(mesh.number_of_vertices(), 0.);
      for (const auto edge : mesh.edges())
        if (kept[edge])
          lengths[chains.root(mesh.vertex(edge, 0))] += length_of(mesh, edge);
      for (const auto edge : mesh.edges())
        if (kept[edge] && lengths[chains.root(mesh.vertex(edge, 0))] < least_chain * edge_length)
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
    /// With some vertices held where they are.
    TriangleSurface
    remesh_holding(const TriangleSurface   &surface,
                   const double             edge_length,
                   const bool               keep_edges,
                   const std::vector<bool> &held_vertices)
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
      auto held = mesh.add_property_map<CgalMesh::Vertex_index, bool>("v:held", false).first;
      for (const auto vertex : mesh.vertices())
        held[vertex] = held_vertices[vertex];
      PMP::isotropic_remeshing(mesh.faces(), edge_length, mesh,
                               PMP::parameters::number_of_iterations(n_iterations)
                                   .number_of_relaxation_steps(3)
                                   .edge_is_constrained_map(kept)
                                   .vertex_is_constrained_map(held)
                                   .face_patch_map(groups));
      return from_cgal_mesh(mesh, [&](const CgalMesh::Face_index face) { return groups[face]; });
    }

    /// Vertices that are farther from a remeshed surface than half of `spacing`, the farthest first,
    /// with that spacing: the tips of ears and tails, which relaxation rounds off.
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
  remesh(const TriangleSurface &surface, const double edge_length, const bool keep_edges)
  {
    const std::vector<bool> none(surface.vertices.size(), false);
    TriangleSurface         result = remesh_holding(surface, edge_length, keep_edges, none);
    const auto              tips   = lost_tips(surface, result, tip_spacing * edge_length);
    return tips == none ? result : remesh_holding(surface, edge_length, keep_edges, tips);
  }
} // namespace Exemplar
