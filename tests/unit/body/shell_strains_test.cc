// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/shell_strains.h>
#include <exemplar/kernels/polar_decomposition.h>

#include <gtest/gtest.h>

#include "shells.h"

namespace Exemplar::Testing
{
  namespace
  {
    void
    expect_near(const std::vector<ShellStrain> &a,
                const std::vector<ShellStrain> &b,
                const double                    tolerance)
    {
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i)
        for (int k = 0; k < 6; ++k)
          EXPECT_NEAR(a[i][k], b[i][k], tolerance) << "triangle " << i << ", number " << k;
    }

    TEST(ShellMesh, HasEdgesWithTheirTriangles)
    {
      const ShellMesh mesh = rectangle(
          2, 1,
          [](const double x, const double y) {
            return Place{ { 2. * x, y, 0. } };
          },
          0.1);
      ASSERT_EQ(mesh.edges().size(), 9U);
      unsigned int n_borders = 0;
      for (const ShellEdge &edge : mesh.edges())
      {
        n_borders += edge.is_border();
        EXPECT_NEAR(edge.normal[2], 1., 1e-15);
        EXPECT_TRUE(edge.is_border() || edge.begin < edge.end);
      }
      EXPECT_EQ(n_borders, 6U);
      for (const ShellTriangle &triangle : mesh.triangles())
        EXPECT_NEAR(triangle.volume(), 0.05, 1e-16);
      for (std::size_t i = 1; i < mesh.edges().size(); ++i)
      {
        const auto ends = [&](const std::size_t e)
        { return std::minmax(mesh.edges()[e].begin, mesh.edges()[e].end); };
        EXPECT_LT(ends(i - 1), ends(i));
      }
    }

    TEST(ShellStrains, VanishAtRestAndInRigidMotions)
    {
      const ShellMesh mesh = bumpy_patch();
      ShellStrains    strains(mesh);
      for (const unsigned int n : { 1000000U, 3U, 1U })
      {
        strains.set_held(every(n, mesh));
        const std::vector<ShellStrain> none(mesh.triangles().size(), ShellStrain{});
        expect_near(strains.strains(rest_positions(strains)), none, 1e-15);
        const Matrix3<double> Q = closest_rotation(
            Matrix3<double>{ { { 0.1, 2., -0.4 }, { -1., 0.3, 0.2 }, { 0.5, 0.1, 0.7 } } });
        const Vector moved = disturbed(strains, 0.,
                                       [&](const Place &x) {
                                         return combine(1., Q * x, 1., Place{ { 1., -2., 3. } });
                                       });
        expect_near(strains.strains(moved), none, 3e-14);
      }
    }

    TEST(ShellStrains, AreThoseOfACylinder)
    {
      // chords of a circle
      const double    R = 2., t = 0.1;
      const ShellMesh mesh = rectangle(
          40, 10,
          [](const double x, const double y) {
            return Place{ { x, 0.5 * y, 0. } };
          },
          t);
      ShellStrains strains(mesh);
      Vector       bent
          = disturbed(strains, 0.,
                      [&](const Place &x) {
                        return Place{ { R * std::sin(x[0] / R), x[1], R * std::cos(x[0] / R) } };
                      });
      const std::vector<double> slopes
          = strains.least_bending_slopes(bent,
                                         [](unsigned int) {
                                           return ShellElasticity{ 0.6, 1. };
                                         });
      for (unsigned int edge = 0; edge < slopes.size(); ++edge)
        bent[3 * mesh.slope_node(edge)] = slopes[edge];
      const auto found = strains.strains(bent);
      for (std::size_t i = 0; i < found.size(); ++i)
      {
        const ShellTriangle &triangle = mesh.triangles()[i];
        const Place          x        = mesh.vertex(triangle.nodes[0]);
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(found[i][k], 0., 1e-4);
        // slopes at free borders are those without a moment
        if (std::abs(x[0] - 0.5) < 0.3 && std::abs(x[1] - 0.25) < 0.1)
        {
          EXPECT_NEAR(found[i][3] + found[i][4], t / std::sqrt(12.) / R, 0.002 * t / R);
        }
      }
    }

    TEST(ShellStrains, AreTheSameWithDirectorsPlacedAsSlopesHaveThem)
    {
      const ShellMesh mesh = bumpy_patch();
      ShellStrains    strains(mesh);
      const Vector    free    = disturbed(strains, 0.05);
      const auto      of_free = strains.strains(free);
      const auto      slopes  = strains.slopes(free);
      for (const unsigned int n : { 1U, 2U })
      {
        ShellStrains with_directors(mesh);
        with_directors.set_held(every(n, mesh));
        Vector held = free;
        for (unsigned int edge = 0; edge < mesh.edges().size(); ++edge)
          if (with_directors.is_held(edge))
          {
            const Place tip = strains.tip(edge, free);
            for (int c = 0; c < 3; ++c)
              held[3 * mesh.slope_node(edge) + c] = tip[c];
          }
        expect_near(with_directors.strains(held), of_free, 1e-13);
        const auto same = with_directors.slopes(held);
        for (std::size_t edge = 0; edge < slopes.size(); ++edge)
          EXPECT_NEAR(same[edge], slopes[edge], 1e-14);
      }
    }

    TEST(ShellStrains, FollowFoldsPastThemselves)
    {
      const ShellMesh mesh({ Place{ { 0., 0., 0. } }, Place{ { 1., 0., 0. } },
                             Place{ { 0.5, 1., 0. } }, Place{ { 0.5, -1., 0. } } },
                           { { { 0, 1, 2 } }, { { 1, 0, 3 } } }, { 0.1, 0.1 });
      ShellStrains    strains(mesh);
      double          last = 0.;
      for (double angle = 0.; angle < 5.; angle += 0.5)
      {
        Vector x            = rest_positions(strains);
        x[3 * 3 + 1]        = -std::cos(angle);
        x[3 * 3 + 2]        = -std::sin(angle);
        const double strain = strains.strains(x)[0][4];
        EXPECT_GE(strain, last);
        EXPECT_NEAR(strain, angle / 2. * mesh.triangles()[0].bending[0][1], 1e-14);
        last = strain;
        strains.update_branches(x);
      }
    }

    TEST(ShellStrains, HaveLeastBendingEnergyForTheirSlopes)
    {
      const ShellMesh mesh = bumpy_patch();
      ShellStrains    strains(mesh);
      Vector          x     = disturbed(strains, 0.05);
      const auto elasticity = [](const unsigned int t) { return ShellElasticity{ 0.6, 1. + t }; };
      const auto energy     = [&]
      {
        double     sum   = 0.;
        const auto found = strains.strains(x);
        for (unsigned int t = 0; t < found.size(); ++t)
          sum += 0.5 * mesh.triangles()[t].volume()
                 * contract(elasticity(t).stress(found[t]), found[t]);
        return sum;
      };
      const auto slopes = strains.least_bending_slopes(x, elasticity);
      for (unsigned int edge = 0; edge < slopes.size(); ++edge)
        x[3 * mesh.slope_node(edge)] = slopes[edge];
      const double least = energy();
      for (unsigned int edge = 0; edge < slopes.size(); ++edge)
      {
        double &u       = x[3 * mesh.slope_node(edge)];
        u               = slopes[edge] + 1e-4;
        const double up = energy();
        u               = slopes[edge] - 1e-4;
        EXPECT_NEAR(up, energy(), 1e-11 * least);
        EXPECT_GT(up, least);
        u = slopes[edge];
      }
      EXPECT_NEAR(strains.slopes(x)[5], slopes[5], 0.);
    }
  } // namespace
} // namespace Exemplar::Testing
