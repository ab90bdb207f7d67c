// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/cgal_search.h>
#include <exemplar/surface/shape/closest_points.h>

#include <CGAL/Simple_cartesian.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    using Kernel    = CGAL::Simple_cartesian<double>;
    using Triangles = std::vector<Kernel::Triangle_3>;
    using Tree      = TriangleSearch<Kernel, Triangles::const_iterator>;

    /// Barycentric coordinates of a point in a triangle, from areas, without the rounding that
    /// makes them negative.
    std::array<double, 3>
    shares(const Kernel::Triangle_3 &triangle, const Kernel::Point_3 &point)
    {
      const Kernel::Vector_3 normal
          = CGAL::cross_product(triangle[1] - triangle[0], triangle[2] - triangle[0]);
      std::array<double, 3> result;
      double                sum = 0.;
      for (int a = 0; a < 3; ++a)
      {
        const auto &b = triangle[a + 1], &c = triangle[a + 2]; // CGAL takes indices modulo 3
        result[a] = std::max(0., CGAL::cross_product(b - point, c - point) * normal);
        sum += result[a];
      }
      for (double &share : result)
        share /= sum;
      return result;
    }
  } // namespace

  std::vector<SurfacePoint>
  closest_points(const TriangleSurface &surface, const std::vector<SurfaceMesh::Vertex> &points)
  {
    const auto corner = [&](const unsigned int v)
    {
      const auto &x = surface.vertices[v];
      return Kernel::Point_3(x[0], x[1], x[2]);
    };
    Triangles                 solid;
    std::vector<unsigned int> number;
    for (unsigned int t = 0; t < surface.triangles.size(); ++t)
    {
      const auto &[a, b, c] = surface.triangles[t];
      const Kernel::Triangle_3 triangle(corner(a), corner(b), corner(c));
      if (triangle.squared_area() > 0.)
      {
        solid.push_back(triangle);
        number.push_back(t);
      }
    }
    Tree tree(solid.cbegin(), solid.cend());
    tree.build();

    std::vector<SurfacePoint> result;
    for (const auto &point : points)
    {
      const auto [place, nearest]
          = tree.closest_point_and_primitive(Kernel::Point_3(point[0], point[1], point[2]));
      result.push_back({ number[nearest - solid.cbegin()], shares(*nearest, place) });
    }
    return result;
  }
} // namespace Exemplar
