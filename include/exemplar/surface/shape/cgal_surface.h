// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cgal_surface_h
#define exemplar_cgal_surface_h

#include <exemplar/surface/shape/triangle_surface.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

// Types of CGAL and conversions, for files cgal_*.cc alone: CGAL's headers take long to compile.

namespace Exemplar
{
  using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using CgalPoint  = CgalKernel::Point_3;
  using CgalMesh   = CGAL::Surface_mesh<CgalPoint>;

  inline CgalPoint
  to_cgal(const SurfaceMesh::Vertex &place)
  {
    return { place[0], place[1], place[2] };
  }

  inline SurfaceMesh::Vertex
  from_cgal(const CgalPoint &point)
  {
    return { { point.x(), point.y(), point.z() } };
  }

  using CgalPoints   = std::vector<CgalPoint>;
  using CgalPolygons = std::vector<std::vector<std::size_t>>;

  /// Appends the vertices and triangles of a surface to a polygon soup.
  inline void
  to_soup(const TriangleSurface &surface, CgalPoints &points, CgalPolygons &polygons)
  {
    for (const auto &vertex : surface.vertices)
      points.push_back(to_cgal(vertex));
    for (const auto &t : surface.triangles)
      polygons.push_back({ t[0], t[1], t[2] });
  }

  /// A surface with manifold edges as a CGAL mesh, vertices and faces in their order.
  inline CgalMesh
  make_cgal_mesh(const TriangleSurface &surface)
  {
    CgalMesh mesh;
    for (const auto &vertex : surface.vertices)
      mesh.add_vertex(to_cgal(vertex));
    for (const auto &t : surface.triangles)
      mesh.add_face(CgalMesh::Vertex_index(t[0]), CgalMesh::Vertex_index(t[1]),
                    CgalMesh::Vertex_index(t[2]));
    return mesh;
  }

  /// The surface of a CGAL mesh, with the groups of `group_of`; vertices without a face are left
  /// out.
  template <typename GroupMap>
  TriangleSurface
  from_cgal_mesh(CgalMesh &mesh, const GroupMap &group_of)
  {
    mesh.collect_garbage();
    TriangleSurface           surface;
    std::vector<unsigned int> index(mesh.number_of_vertices());
    for (const auto vertex : mesh.vertices())
      if (!mesh.is_isolated(vertex))
      {
        index[vertex] = static_cast<unsigned int>(surface.vertices.size());
        surface.vertices.push_back(from_cgal(mesh.point(vertex)));
      }
    for (const auto face : mesh.faces())
    {
      std::array<unsigned int, 3> triangle;
      auto                        halfedge = mesh.halfedge(face);
      for (unsigned int &vertex : triangle)
      {
        vertex   = index[mesh.source(halfedge)];
        halfedge = mesh.next(halfedge);
      }
      surface.triangles.push_back(triangle);
      surface.groups.push_back(group_of(face));
    }
    return surface;
  }
} // namespace Exemplar

#endif
