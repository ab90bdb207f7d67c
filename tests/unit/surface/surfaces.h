// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_surfaces_h
#define exemplar_tests_surfaces_h

#include <exemplar/surface/shape/triangle_surface.h>

#include <utility>

namespace Exemplar::Testing
{
  /// Twelve triangles in two groups: z = 0 is of 0, the other faces are of 1.
  inline TriangleSurface
  cube(const SurfaceMesh::Vertex &origin = { { 0., 0., 0. } }, const double size = 1.)
  {
    SurfaceMesh mesh;
    for (unsigned int i = 0; i < 8; ++i)
      mesh.vertices.push_back({ { origin[0] + size * (i % 2), origin[1] + size * (i / 2 % 2),
                                  origin[2] + size * (i / 4) } });
    mesh.faces       = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
                         { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
    mesh.face_groups = { 0, 1, 1, 1, 1, 1 };
    return triangulate(mesh);
  }

  inline TriangleSurface
  turned(TriangleSurface surface)
  {
    for (auto &t : surface.triangles)
      std::swap(t[0], t[1]);
    return surface;
  }

  inline TriangleSurface
  joined(TriangleSurface a, const TriangleSurface &b)
  {
    const auto n = static_cast<unsigned int>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    a.groups.insert(a.groups.end(), b.groups.begin(), b.groups.end());
    for (const auto &t : b.triangles)
      a.triangles.push_back({ { t[0] + n, t[1] + n, t[2] + n } });
    return a;
  }
} // namespace Exemplar::Testing

#endif
