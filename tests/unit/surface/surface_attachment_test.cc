// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/surface/skin/surface_attachment.h>

#include "fold_bodies.h"
#include "matrices.h"
#include "surfaces.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// Nearest among many points of all triangles: slow, but without doubt.
    double
    distance_by_sampling(const Points                                   &vertices,
                         const std::vector<std::array<unsigned int, 3>> &triangles,
                         const dealii::Point<3>                         &x)
    {
      double    minimum = 1e300;
      const int n       = 60;
      for (const auto &triangle : triangles)
        for (int i = 0; i <= n; ++i)
          for (int j = 0; i + j <= n; ++j)
          {
            const dealii::Point<3> p
                = vertices[triangle[0]]
                  + double(i) / n * (vertices[triangle[1]] - vertices[triangle[0]])
                  + double(j) / n * (vertices[triangle[2]] - vertices[triangle[0]]);
            minimum = std::min(minimum, p.distance(x));
          }
      return minimum;
    }

    TEST(ClosestPoints, AgreeWithSampling)
    {
      std::mt19937                                   generator(5);
      Points                                         corners, points;
      const std::vector<std::array<unsigned int, 3>> triangles
          = { { { 0, 1, 2 } }, { { 2, 1, 3 } }, { { 4, 5, 5 } }, { { 4, 5, 6 } } };
      for (int k = 0; k < 12; ++k)
      {
        const Matrix3<double> A = random_matrix(generator);
        corners.emplace_back(A[0][0], A[0][1], A[0][2]);
        points.emplace_back(2. * A[1][0], 2. * A[1][1], 2. * A[1][2]);
      }
      const auto found = closest_points({ vertices(corners), triangles, {} }, vertices(points));
      for (std::size_t k = 0; k < points.size(); ++k)
      {
        EXPECT_NE(found[k].triangle, 2u);
        dealii::Point<3> place;
        for (int a = 0; a < 3; ++a)
        {
          EXPECT_GE(found[k].share[a], 0.);
          place += found[k].share[a] * corners[triangles[found[k].triangle][a]];
        }
        EXPECT_NEAR(found[k].share[0] + found[k].share[1] + found[k].share[2], 1., 1e-14);
        const double expected = distance_by_sampling(corners, triangles, points[k]);
        EXPECT_LE(place.distance(points[k]), expected + 1e-12);
        EXPECT_NEAR(place.distance(points[k]), expected, 2e-3);
      }
    }

    TEST(SurfaceAttachment, AreasAreThoseOfTheBoundary)
    {
      const Mesh              bar = small_bar();
      const SurfaceAttachment attachment(bar.get_nodes(), bar.get_boundary_faces(),
                                         boundary_of(bar, bar.get_nodes()));
      double                  sum = 0.;
      for (const double area : attachment.get_areas())
        sum += area;
      EXPECT_NEAR(sum, 18., 1e-12);
      EXPECT_EQ(attachment.get_nodes().size(), 2u * 9u + 7u * 8u);
      for (const double distance : attachment.get_distances())
        EXPECT_NEAR(distance, 0., 1e-14);
    }

    TEST(SurfaceAttachment, AGapThatTheMeshDoesNotResolveIsNotCrossed)
    {
      // two bodies .01 apart; the first one's mesh comes nearer to the other's surface than to its own
      Points nodes;
      for (const double x : { 1.008, 0. })
        for (const auto &[y, z] : { std::pair(.1, .1), { .9, .1 }, { .9, .9 }, { .1, .9 } })
          nodes.emplace_back(x, y, z);
      const std::vector<BoundaryFace> faces = { { { { 0, 1, 2 } }, 0 },
                                                { { { 0, 2, 3 } }, 0 },
                                                { { { 4, 6, 5 } }, 0 },
                                                { { { 4, 7, 6 } }, 0 } };
      const TriangleSurface           two   = joined(cube(), cube({ { 1.01, 0., 0. } }));
      const SurfaceAttachment         attachment(nodes, faces, two);
      for (std::size_t k = 0; k < nodes.size(); ++k)
      {
        EXPECT_LT(attachment.get_points()[k].triangle, 12u);
        EXPECT_NEAR(attachment.get_distances()[k], k < 4 ? .008 : 0., 1e-12);
      }
    }

    TEST(SurfaceAttachment, TheDistanceFromTheSurfaceTurnsWithIt)
    {
      // a bar inside a box that is larger by a tenth all around
      const Mesh   bar = small_bar();
      const Points box
          = mapped(bar.get_nodes(), [](const dealii::Point<3> &x)
                   { return dealii::Point<3>(1.05 * (x[0] - 2.) + 2., 1.2 * x[1], 1.2 * x[2]); });
      const SurfaceAttachment attachment(bar.get_nodes(), bar.get_boundary_faces(),
                                         boundary_of(bar, box));
      const Matrix3<double>   R    = rotation_about({ { 1., -2., .5 } }, 2.);
      const auto              turn = [&](const dealii::Point<3> &x)
      {
        dealii::Point<3> y;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            y[i] += R[i][j] * x[j];
        return y;
      };
      const Points targets = attachment.targets(vertices(mapped(box, turn)));
      for (std::size_t k = 0; k < targets.size(); ++k)
      {
        EXPECT_NEAR(attachment.get_distances()[k], 0.1, 1e-12);
        EXPECT_LT(targets[k].distance(turn(bar.get_nodes()[attachment.get_nodes()[k]])), 1e-12);
      }
    }

    TEST(SurfaceAttachment, ASurfaceOfAnotherBodyIsRefused)
    {
      const Mesh bar       = small_bar();
      const auto complaint = [&](const Points &surface)
      {
        const SurfaceAttachment attachment(bar.get_nodes(), bar.get_boundary_faces(),
                                           boundary_of(bar, surface));
        try
        {
          check_attachment(attachment, bar, "rest.obj");
        }
        catch (const UserError &error)
        {
          return std::string(error.what());
        }
        return std::string();
      };
      EXPECT_EQ(complaint(bar.get_nodes()), "");
      const std::string swapped = complaint(mapped(bar.get_nodes(), [](const dealii::Point<3> &x)
                                                   { return dealii::Point<3>(x[1], x[0], x[2]); }));
      EXPECT_NE(swapped.find("is no mesh of the inside of rest.obj: node "), std::string::npos);
      EXPECT_NE(swapped.find("axes"), std::string::npos);
      EXPECT_NE(
          complaint(mapped(bar.get_nodes(), [](const dealii::Point<3> &x)
                           { return dealii::Point<3>(1000. * x[0], 1000. * x[1], 1000. * x[2]); })),
          "");
    }
  } // namespace
} // namespace Exemplar::Testing
