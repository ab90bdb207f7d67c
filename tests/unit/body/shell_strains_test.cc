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

    constexpr HeldComponents x_held = 1, y_held = 2, z_held = 4;

    /// A curved patch, and its edges in the plane y = 0, of which these components of tips are held.
    struct InPlane
    {
      explicit InPlane(const HeldComponents components)
          : mesh(rectangle(
              4,
              3,
              [](const double x, const double y) {
                return Place{ { x, 0.5 * y, 0.1 * std::cos(1.5 * x) * std::cos(0.3 * y) } };
              },
              0.05)),
            held(mesh.edges().size(), 0), strains(mesh)
      {
        for (unsigned int edge = 0; edge < held.size(); ++edge)
          if (std::abs(mesh.vertex(mesh.edges()[edge].begin)[1]) < 1e-9
              && std::abs(mesh.vertex(mesh.edges()[edge].end)[1]) < 1e-9)
            held[edge] = components;
        strains.set_held(held);
      }

      /// At rest, with the vertices moved by a function and the slope nodes as they are.
      Vector
      moved(const std::function<Place(const Place &)> &motion) const
      {
        Vector positions = rest_positions(strains);
        for (unsigned int node = 0; node < mesh.n_vertices(); ++node)
        {
          const Place x = motion(mesh.vertex(node));
          for (int c = 0; c < 3; ++c)
            positions[3 * node + c] = x[c];
        }
        return positions;
      }

      ShellMesh    mesh;
      HeldTips     held;
      ShellStrains strains;
    };

    TEST(ShellStrains, LetTipsFollowTheirEdgesInComponentsThatAreFree)
    {
      for (const HeldComponents held :
           { y_held, HeldComponents(y_held | z_held), HeldComponents(x_held | y_held) })
      {
        const InPlane                  shell(held);
        const std::vector<ShellStrain> none(shell.mesh.triangles().size(), ShellStrain{});
        const auto                     far = [&](const Place &x)
        {
          return combine(1., x, 1.,
                         Place{ { held & x_held ? 0. : 30., 0., held & z_held ? 0. : -50. } });
        };
        expect_near(shell.strains.strains(shell.moved(far)), none, 1e-13);
      }
    }

    TEST(ShellStrains, StayInAPlaneOfSymmetryHoweverEdgesTurn)
    {
      InPlane                        shell(y_held);
      const std::vector<ShellStrain> none(shell.mesh.triangles().size(), ShellStrain{});
      for (double angle = 0.25; angle < 6.5; angle += 0.25)
      {
        const Vector turned = shell.moved(
            [&](const Place &x)
            {
              return Place{ { std::cos(angle) * x[0] - std::sin(angle) * x[2], x[1],
                              std::sin(angle) * x[0] + std::cos(angle) * x[2] } };
            });
        expect_near(shell.strains.strains(turned), none, 1e-14);
        shell.strains.update_branches(turned);
      }
    }

    TEST(ShellStrains, HaveDerivativesWhereTipsFollowTheirEdges)
    {
      for (const HeldComponents held : { y_held, HeldComponents(y_held | z_held) })
      {
        const InPlane            shell(held);
        const Vector             at = disturbed(shell.strains, 0.03);
        std::vector<ShellStrain> stresses(shell.mesh.triangles().size());
        for (std::size_t t = 0; t < stresses.size(); ++t)
          for (int k = 0; k < 6; ++k)
            stresses[t][k] = std::sin(1. + 6. * static_cast<double>(t) + k);
        Vector gradient(at.size());
        shell.strains.add_pulled_back(at, stresses, gradient);
        const auto product = [&](const Vector &x)
        {
          double     sum   = 0.;
          const auto found = shell.strains.strains(x);
          for (std::size_t t = 0; t < found.size(); ++t)
            sum += contract(stresses[t], found[t]);
          return sum;
        };
        constexpr double h = 1e-6;
        for (unsigned int dof = 0; dof < at.size(); ++dof)
        {
          Vector after = at, before = at;
          after[dof] += h;
          before[dof] -= h;
          EXPECT_NEAR((product(after) - product(before)) / (2. * h), gradient[dof], 1e-8);
        }
      }
    }

    TEST(ShellStrains, HaveTheChainRuleOfLeastBendingSlopes)
    {
      const ShellMesh mesh = bumpy_patch();
      ShellStrains    strains(mesh);
      Vector          x          = disturbed(strains, 0.05);
      double          changed    = 0.; // of one triangle's mu
      const auto      elasticity = [&](const unsigned int t) {
        return ShellElasticity{ 0.6, 1. + t + (t == 3 ? changed : 0.) };
      };
      const auto slopes = [&](const double change)
      {
        changed = change;
        return strains.least_bending_slopes(x, elasticity);
      };
      const auto          up = slopes(1e-5), down = slopes(-1e-5), at = slopes(0.);
      std::vector<double> by_slopes;
      double              quotient = 0.;
      for (std::size_t edge = 0; edge < at.size(); ++edge)
      {
        by_slopes.push_back(std::cos(static_cast<double>(edge)));
        quotient += by_slopes[edge] * (up[edge] - down[edge]) / 2e-5;
        x[3 * mesh.slope_node(edge)] = at[edge];
      }
      ShellStrain curvature = strains.strains(x)[3];
      curvature[0] = curvature[1] = curvature[2] = 0.;
      const ShellStrain adjoint = strains.adjoint_of_least_bending(by_slopes, elasticity)[3];
      EXPECT_NEAR(-mesh.triangles()[3].volume()
                      * contract(ShellElasticity{ 0., 1. }.stress(curvature), adjoint),
                  quotient, 1e-8 * std::abs(quotient));
    }
  } // namespace
} // namespace Exemplar::Testing
