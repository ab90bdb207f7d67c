// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/cgal_surface.h>
#include <exemplar/surface/surface_edges.h>
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
  } // namespace

  TriangleSurface
  remesh(const TriangleSurface &surface, const double edge_length, const bool keep_edges)
  {
    CgalMesh mesh = make_cgal_mesh(surface);
    Groups groups = mesh.add_property_map<CgalMesh::Face_index, unsigned int>("f:group", 0U).first;
    for (const auto face : mesh.faces())
      groups[face] = surface.groups[face];
    Kept kept = mesh.add_property_map<CgalMesh::Edge_index, bool>("e:kept", false).first;
    if (keep_edges)
      keep_sharp_edges(mesh, edge_length, kept);
    keep_borders(mesh, groups, kept);
    PMP::isotropic_remeshing(mesh.faces(), edge_length, mesh,
                             PMP::parameters::number_of_iterations(n_iterations)
                                 .number_of_relaxation_steps(3)
                                 .edge_is_constrained_map(kept)
                                 .face_patch_map(groups));
    return from_cgal_mesh(mesh, [&](const CgalMesh::Face_index face) { return groups[face]; });
  }
} // namespace Exemplar
