// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/vertex_normals.h>

namespace Exemplar
{
  std::vector<SpaceVector>
  vertex_normals(const std::vector<std::vector<unsigned int>> &polygons,
                 const std::vector<SpaceVector>               &vertices)
  {
    std::vector<SpaceVector> normals(vertices.size(), { { 0., 0., 0. } });
    for (const auto &polygon : polygons)
    {
      SpaceVector normal{ { 0., 0., 0. } };
      for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        normal = plus(normal, 1.,
                      cross(minus(vertices[polygon[i]], vertices[polygon[0]]),
                            minus(vertices[polygon[i + 1]], vertices[polygon[0]])));
      const double length = norm(normal);
      for (std::size_t i = 0; length > 0. && i < polygon.size(); ++i)
      {
        const SpaceVector &x    = vertices[polygon[i]];
        const SpaceVector  next = minus(vertices[polygon[(i + 1) % polygon.size()]], x);
        const SpaceVector  last
            = minus(vertices[polygon[(i + polygon.size() - 1) % polygon.size()]], x);
        const double angle  = std::atan2(norm(cross(next, last)), dot(next, last));
        normals[polygon[i]] = plus(normals[polygon[i]], angle / length, normal);
      }
    }
    for (SpaceVector &normal : normals)
      if (const double length = norm(normal); length > 0.)
        normal = plus({ { 0., 0., 0. } }, 1. / length, normal);
      else
        normal = { { 0., 0., 1. } };
    return normals;
  }
} // namespace Exemplar
