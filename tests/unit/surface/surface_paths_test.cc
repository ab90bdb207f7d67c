// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/surface_paths.h>

#include "surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr double no_limit = std::numeric_limits<double>::infinity();

    /// n by n squares of unit length on (x, y, z)(u, v), cut in two along the same diagonals.
    template <typename Place>
    TriangleSurface
    sheet(const unsigned int n, const Place &place)
    {
      TriangleSurface surface;
      for (unsigned int j = 0; j <= n; ++j)
        for (unsigned int i = 0; i <= n; ++i)
          surface.vertices.push_back(place(double(i) / n, double(j) / n));
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
        {
          const unsigned int a = j * (n + 1) + i, b = a + n + 1;
          surface.triangles.push_back({ { a, a + 1, b + 1 } });
          surface.triangles.push_back({ { a, b + 1, b } });
        }
      surface.groups.resize(surface.triangles.size(), 0);
      return surface;
    }

    /// At a vertex.
    double
    path_to(const SurfacePaths &paths, const TriangleSurface &surface, const unsigned int vertex)
    {
      for (unsigned int t = 0; t < surface.triangles.size(); ++t)
        for (unsigned int a = 0; a < 3; ++a)
          if (surface.triangles[t][a] == vertex)
          {
            SurfacePoint point{ t, { { 0., 0., 0. } } };
            point.share[a] = 1.;
            return paths.distance(point);
          }
      return no_limit;
    }

    /// The greatest relative error of distances from the first vertex of a sheet, where `exact`
    /// gives them.
    template <typename Exact>
    double
    max_error(const TriangleSurface &surface, const unsigned int n, const Exact &exact)
    {
      const SurfacePaths paths(surface, { 0 }, no_limit);
      double             error = 0.;
      for (unsigned int v = 1; v < surface.vertices.size(); ++v)
      {
        const double expected = exact(double(v % (n + 1)) / n, double(v / (n + 1)) / n);
        const double found    = path_to(paths, surface, v);
        EXPECT_GE(found, expected * (1. - 1e-3)); // chords of a curved sheet are shorter than arcs
        error = std::max(error, found / expected - 1.);
      }
      return error;
    }

    TEST(SurfacePaths, AreNearlyStraightInAPlane)
    {
      const unsigned int n     = 12;
      const auto         plane = sheet(n,
                                       [](const double u, const double v) {
                                 return SurfaceMesh::Vertex{ { u, v, 0. } };
                               });
      const double       error
          = max_error(plane, n, [](const double u, const double v) { return std::hypot(u, v); });
      EXPECT_LT(error, 0.01);
      RecordProperty("error", std::to_string(error));
    }

    TEST(SurfacePaths, GoAroundACylinder)
    {
      const unsigned int n = 24;
      const auto         cylinder
          = sheet(n,
                  [](const double u, const double v) {
                    return SurfaceMesh::Vertex{ { std::cos(3. * u), std::sin(3. * u), v } };
                  });
      EXPECT_LT(max_error(cylinder, n,
                          [](const double u, const double v) { return std::hypot(3. * u, v); }),
                0.03); // triangles three times as long as wide
    }

    TEST(SurfacePaths, CrossTheEdgesOfACube)
    {
      const TriangleSurface box = cube();
      const SurfacePaths    paths(box, { 0 }, no_limit);
      const auto            far
          = closest_points(box, { { { 1., 1., 1. } }, { { 1., .5, .5 } }, { { 1., .5, 0. } } });
      EXPECT_NEAR(paths.distance(far[0]), std::sqrt(5.), 0.01 * std::sqrt(5.));
      EXPECT_NEAR(paths.distance(far[1]), std::hypot(1.5, .5), 0.01 * std::hypot(1.5, .5));
      EXPECT_NEAR(paths.distance(far[2]), std::hypot(1., .5), 0.01 * std::hypot(1., .5));
      EXPECT_EQ(path_to(paths, box, 0), 0.);
    }

    TEST(SurfacePaths, PassWhereVerticesAreAtOnePlace)
    {
      // two squares side by side without a common vertex, and a third one on their common edge
      TriangleSurface parts = sheet(1,
                                    [](const double u, const double v) {
                                      return SurfaceMesh::Vertex{ { u, v, 0. } };
                                    });
      for (const double turn : { 0., 1. })
        parts = joined(parts,
                       sheet(1,
                             [turn](const double u, const double v) {
                               return SurfaceMesh::Vertex{ { 1. + (1. - turn) * u, v, turn * u } };
                             }));
      const SurfacePaths paths(parts, { 0 }, no_limit);
      EXPECT_NEAR(path_to(paths, parts, 5), 2., 1e-12);
      EXPECT_NEAR(path_to(paths, parts, 9), 2., 1e-12);
      EXPECT_NEAR(path_to(paths, parts, 7), std::sqrt(5.), 0.03);
    }

    TEST(SurfacePaths, EndAtTheirLimit)
    {
      const TriangleSurface box = cube();
      const SurfacePaths    paths(box, { 0, 1 }, 1.2);
      EXPECT_EQ(path_to(paths, box, 1), 0.);
      EXPECT_EQ(path_to(paths, box, 2), 1.);
      EXPECT_EQ(path_to(paths, box, 7), no_limit);
    }
  } // namespace
} // namespace Exemplar::Testing
