// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/surface/skin/surface_skin.h>

#include "expect_contains.h"
#include "fold_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace Exemplar::Testing
{
  namespace
  {
    Vector
    displacement_to(const Mesh &mesh, const Points &places)
    {
      Vector u(3 * mesh.n_nodes());
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          u[3 * node + c] = places[node][c] - mesh.get_nodes()[node][c];
      return u;
    }

    Points
    points_of(const std::vector<SurfaceMesh::Vertex> &vertices)
    {
      Points points;
      for (const auto &x : vertices)
        points.emplace_back(x[0], x[1], x[2]);
      return points;
    }

    /// A tube of squares around the bar, at a distance from its sides, and a ring more at each end.
    SurfaceMesh
    coat(const double distance, const unsigned int n_along = 80, const unsigned int n_side = 20)
    {
      SurfaceMesh        surface;
      const double       half = .5 + distance;
      const unsigned int n    = 4 * n_side;
      for (unsigned int i = 0; i <= n_along; ++i)
        for (unsigned int j = 0; j < n; ++j)
        {
          const double                s = 2. * half * (j % n_side) / n_side - half;
          const std::array<double, 2> sides[4]
              = { { { s, -half } }, { { half, s } }, { { -s, half } }, { { -half, -s } } };
          const std::array<double, 2> &yz = sides[j / n_side];
          surface.vertices.push_back({ { 4. * i / n_along, yz[0], yz[1] } });
          if (i < n_along)
            surface.faces.push_back(
                { i * n + j, i * n + (j + 1) % n, (i + 1) * n + (j + 1) % n, (i + 1) * n + j });
        }
      return surface;
    }

    /// The greatest ratio of an edge's length to what it was.
    double
    max_stretch(const SurfaceMesh &surface, const Points &places)
    {
      const Points rest    = points_of(surface.vertices);
      double       maximum = 0.;
      for (const auto &face : surface.faces)
        for (std::size_t k = 0; k < face.size(); ++k)
        {
          const unsigned int a = face[k], b = face[(k + 1) % face.size()];
          maximum = std::max(maximum, places[a].distance(places[b]) / rest[a].distance(rest[b]));
        }
      return maximum;
    }

    Points
    carried(const SurfaceMesh &surface, const Mesh &mesh, const Points &places)
    {
      return points_of(skin_of_carried(surface, mesh, "coat").carry(displacement_to(mesh, places)));
    }

    TEST(CarriedSkin, AffineMotionsAreCarriedExactlyInsideOnAndOutside)
    {
      const Mesh bar = small_bar(2);
      const auto map = [](const dealii::Point<3> &x)
      { return dealii::Point<3>(2. * x[0] - x[1] + 3., .5 * x[1] + x[2], x[2] - 4. * x[0]); };
      for (const double distance : { -.4, -.1, 0., .05, .2, 2. })
      {
        const SurfaceMesh surface = coat(distance, 20, 5);
        EXPECT_LT(max_distance_between(carried(surface, bar, mapped(bar.get_nodes(), map)),
                                       mapped(points_of(surface.vertices), map)),
                  1e-11)
            << distance;
        EXPECT_EQ(skin_of_carried(surface, bar, "coat").carry(Vector(3 * bar.n_nodes())),
                  surface.vertices);
      }
    }

    TEST(CarriedSkin, QuadraticMotionsAreCarriedNearlyExactlyNearTheBody)
    {
      const Mesh bar = small_bar(3);
      const auto map = [](const dealii::Point<3> &x)
      {
        return dealii::Point<3>(x[0] + .2 * x[0] * x[0] - .3 * x[1] * x[2], x[1] - .4 * x[0] * x[1],
                                .7 * x[2] + .1 * x[2] * x[2]);
      };
      for (const double distance : { -.2, 0. })
      {
        const SurfaceMesh surface = coat(distance, 20, 5);
        EXPECT_LT(max_distance_between(carried(surface, bar, mapped(bar.get_nodes(), map)),
                                       mapped(points_of(surface.vertices), map)),
                  3e-4 * bar.diameter());
      }
    }

    TEST(CarriedSkin, SheetsAtOnePlaceStayTogetherWhicheverWayTheyFace)
    {
      const Mesh  bar     = small_bar(2);
      SurfaceMesh surface = coat(.05, 20, 5), lining = surface;
      for (auto &face : lining.faces)
        std::reverse(face.begin(), face.end());
      const Points places = bent(bar.get_nodes(), 2.);
      EXPECT_EQ(carried(surface, bar, places), carried(lining, bar, places));
    }

    /// Bent as a joint is, within a length of the bar's width.
    Points
    folded(const Points &points, const double angle)
    {
      return mapped(points,
                    [angle](const dealii::Point<3> &x)
                    {
                      const double share = std::min(1., std::max(0., x[0] - 1.5));
                      const double a     = angle * share * share * (3. - 2. * share);
                      const double d     = x[0] - 2.;
                      return dealii::Point<3>(2. + d * std::cos(a) - x[2] * std::sin(a), x[1],
                                              x[2] * std::cos(a) + d * std::sin(a));
                    });
    }

    TEST(CarriedSkin, ACoatFivePercentOutsideDoesNotTearOverABentJoint)
    {
      const Mesh        bar     = small_bar(4);
      const SurfaceMesh on_body = coat(0.), surface = coat(.05 * bar.diameter());
      const Points      places = folded(bar.get_nodes(), 1.5);
      const double      of_motion
          = max_stretch(surface, folded(points_of(surface.vertices), 1.5)); // of all space
      const double of_coat = max_stretch(surface, carried(surface, bar, places));
      EXPECT_GT(of_coat, 1.1);
      EXPECT_LT(of_coat, 1.25 * of_motion);
      EXPECT_LT(max_stretch(on_body, carried(on_body, bar, places)), 1.1 * of_motion);
    }

    /// Two bars side by side that hang together at x < .5, with a gap of .2 between them.
    Mesh
    two_limbs()
    {
      MeshParameters parameters;
      parameters.generator = MeshGenerator::box;
      parameters.box_size  = { { 4., 2.2, 1. } };
      parameters.box_cells = { { 16, 11, 4 } };
      MshFile    msh       = Mesh(parameters).get_contents();
      const auto is_in_gap = [&msh](const MshElement &element)
      {
        dealii::Tensor<1, 3> centre;
        for (const auto node : element.nodes)
          centre += msh.nodes[node] / static_cast<double>(element.nodes.size());
        return centre[0] > .5 && std::abs(centre[1]) < .1 - 1e-9;
      };
      msh.elements.erase(std::remove_if(msh.elements.begin(), msh.elements.end(), is_in_gap),
                         msh.elements.end());
      return Mesh(msh, "limbs");
    }

    TEST(CarriedSkin, ACoatOverTwoLimbsThatPartDoesNotTear)
    {
      const Mesh  limbs = two_limbs();
      SurfaceMesh sheet;
      for (unsigned int i = 0; i <= 40; ++i)
        for (unsigned int j = 0; j <= 60; ++j)
        {
          sheet.vertices.push_back({ { .1 * i, -1.1 + 2.2 * j / 60., .7 } });
          if (i < 40 && j < 60)
            sheet.faces.push_back({ 61 * i + j, 61 * i + j + 1, 61 * i + j + 62, 61 * i + j + 61 });
        }
      const Points places = mapped(limbs.get_nodes(),
                                   [](const dealii::Point<3> &x)
                                   {
                                     const double lift
                                         = x[1] > 0. ? .5 * std::max(0., x[0] - .5) / 3.5 : 0.;
                                     return dealii::Point<3>(x[0], x[1], x[2] + lift);
                                   });
      EXPECT_GT(max_stretch(sheet, carried(sheet, limbs, places)), 1.1);
      EXPECT_LT(max_stretch(sheet, carried(sheet, limbs, places)), 3.);
    }

    TEST(CarriedSkin, EyesInsideKeepTheirShapeAsTheBodyBends)
    {
      const Mesh  bar = small_bar(4);
      SurfaceMesh eye;
      for (int i = 0; i < 200; ++i)
      {
        const double z = -1. + (i + .5) / 100., r = std::sqrt(1. - z * z), a = 2.39996 * i;
        eye.vertices.push_back(
            { { 2. + .1 * r * std::cos(a), .1 * r * std::sin(a), .3 + .1 * z } });
      }
      const auto places = carried(eye, bar, bent(bar.get_nodes(), 1.));
      const auto exact  = bent(points_of(eye.vertices), 1.);
      EXPECT_LT(max_distance_between(places, exact), 1e-3); // the body's own motion
    }

    TEST(CarriedSkin, ASurfaceInAnotherUnitIsRefused)
    {
      SurfaceMesh surface = coat(.05, 2, 2);
      for (auto &vertex : surface.vertices)
        vertex[0] *= 1000.;
      try
      {
        skin_of_carried(surface, small_bar(2), "Mesh/Carry: coat");
        FAIL() << "it was taken";
      }
      catch (const UserError &error)
      {
        for (const char *part : { "Mesh/Carry: coat: vertex ", "in the unit and axes" })
          expect_contains(error.what(), part);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
