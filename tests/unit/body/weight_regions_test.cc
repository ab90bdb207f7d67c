// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/parts_of_graph.h>
#include <exemplar/body/weight_regions.h>

#include "body.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

namespace Exemplar::Testing
{
  namespace
  {
    using Parts = std::vector<unsigned int>;

    /// parts_of_graph() of nodes in a row, each of the same size, with heights whose sums become one.
    Parts
    parts_of_row(std::vector<std::vector<double>> heights)
    {
      const std::size_t                        n = heights.front().size();
      std::vector<std::array<unsigned int, 2>> edges;
      for (unsigned int node = 1; node < n; ++node)
        edges.push_back({ node - 1, node });
      for (std::vector<double> &of_quantity : heights)
      {
        const double sum = std::accumulate(of_quantity.begin(), of_quantity.end(), 0.);
        for (double &height : of_quantity)
          height /= sum;
      }
      return parts_of_graph(edges, std::vector<double>(n, 1.), heights);
    }

    TEST(PartsOfGraph, DivideWhereThePassIsLow)
    {
      EXPECT_EQ(parts_of_row({ { 1., 4., 1., 4., 1., 0. } }), (Parts{ 0, 0, 0, 1, 1, 1 }));
      EXPECT_EQ(parts_of_row({ { 1., 4., 2., 4., 1., 0. } }), (Parts(6, 0))); // sqrt(1/2) > .6
    }

    TEST(PartsOfGraph, DivideWhereAnotherQuantityBegins)
    {
      EXPECT_EQ(parts_of_row({ { 5., 5., 4., 0., 0. }, { 0., 0., 4., 5., 5. } }),
                (Parts{ 0, 0, 0, 1, 1 }));
      EXPECT_EQ(parts_of_row({ { 5., 5., 4., 5., 5. }, { 5., 5., 4., 5., 5. } }), Parts(5, 0));
    }

    TEST(PartsOfGraph, LeaveNoCrumbs)
    {
      EXPECT_EQ(parts_of_row({ { 100., 10., 0.1, 1., 0.1 } }), Parts(5, 0)); // 1 %
    }

    TEST(PartsOfGraph, WithoutHeightAreOne)
    {
      const std::vector<std::array<unsigned int, 2>> edges(1, { { 0, 1 } });
      EXPECT_EQ(parts_of_graph(edges, { 1., 1., 1. }, {}), Parts(3, 0));
    }

    using Map = std::function<dealii::Point<3>(const dealii::Point<3> &)>;

    PoseOfBody
    pose_of(const Mesh &mesh, const std::string &name, const Map &map)
    {
      PoseOfBody pose{ name, {} };
      for (const dealii::Point<3> &node : mesh.get_nodes())
        pose.places.push_back(map(node));
      return pose;
    }

    double
    bump(const double x, const double at)
    {
      return 0.3 * std::exp(-std::pow((x - at) / 0.5, 2));
    }

    /// Bumps of a bar of length 8 at x = 2 and at x = 6, in one pose or in one each.
    std::vector<PoseOfBody>
    two_bumps(const Mesh &mesh, const bool in_one, const double unit = 1.)
    {
      const auto with = [&](const std::string &name, const double first, const double second)
      {
        return pose_of(mesh, name,
                       [&](const dealii::Point<3> &p)
                       {
                         const double x = p[0] / unit;
                         return dealii::Point<3>(
                             p[0], p[1],
                             p[2] + unit * (first * bump(x, 2.) + second * bump(x, 6.)));
                       });
      };
      if (in_one)
        return { with("both", 1., 1.) };
      return { with("left", 1., 0.), with("right", 0., 0.5) };
    }

    const MeshParameters long_bar = box_mesh(8., 32, 2);

    /// The greatest difference between shares of regions that are the same.
    double
    difference(const WeightRegions &a, const WeightRegions &b)
    {
      double greatest = a.shares.size() == b.shares.size() ? 0. : 1.;
      for (std::size_t region = 0; greatest < 1. && region < a.shares.size(); ++region)
        for (std::size_t cell = 0; cell < a.shares[region].size(); ++cell)
          greatest = std::max(greatest, std::abs(a.shares[region][cell] - b.shares[region][cell]));
      return greatest;
    }

    TEST(WeightRegions, AreWhereExamplesStrainTheBody)
    {
      const Mesh mesh(long_bar);
      for (const bool in_one : { true, false })
      {
        const WeightRegions found = find_weight_regions(mesh, two_bumps(mesh, in_one));
        ASSERT_EQ(found.regions.size(), 2u);
        const unsigned int left = found.regions[0].centre[0] < 4. ? 0 : 1;
        EXPECT_NEAR(found.regions[left].centre[0], 2., 0.3);
        EXPECT_NEAR(found.regions[1 - left].centre[0], 6., 0.3);
        EXPECT_EQ(found.regions[left].example, in_one ? "both" : "left");
        EXPECT_EQ(found.regions[1 - left].example, in_one ? "both" : "right");
        EXPECT_NEAR(found.regions[0].volume + found.regions[1].volume, 1., 1e-12);
        EXPECT_EQ(found.regions[0].n_cells + found.regions[1].n_cells, mesh.n_cells());
        for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        {
          const double x = mesh.get_nodes()[mesh.corners(cell)[0]][0];
          EXPECT_NEAR(found.shares[0][cell] + found.shares[1][cell], 1., 1e-14);
          if (x < 2.5 || x > 5.5)
          {
            EXPECT_NEAR(found.shares[left][cell], x < 2.5 ? 1. : 0., 0.02);
          }
        }
      }
    }

    TEST(WeightRegions, DoNotDependOnTheUnit)
    {
      const Mesh          mesh(long_bar);
      const WeightRegions found = find_weight_regions(mesh, two_bumps(mesh, false));
      const Mesh          in_mm(mesh.get_contents(), "test", 1e3);
      const WeightRegions same = find_weight_regions(in_mm, two_bumps(in_mm, false, 1e3));
      EXPECT_LT(difference(found, same), 1e-9);
      EXPECT_NEAR(same.regions[0].centre[0], 1e3 * found.regions[0].centre[0], 1e-6);
    }

    TEST(WeightRegions, DoNotDependOnTheNumbersOfNodes)
    {
      const Mesh                mesh(long_bar);
      MshFile                   contents = mesh.get_contents();
      std::vector<unsigned int> number(mesh.n_nodes());
      std::iota(number.begin(), number.end(), 0);
      std::shuffle(number.begin(), number.end(), std::mt19937(1));
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        contents.nodes[number[node]] = mesh.get_nodes()[node];
      for (MshElement &element : contents.elements)
        for (auto &node : element.nodes)
          node = number[node];
      const Mesh shuffled(contents, "test");
      EXPECT_LT(difference(find_weight_regions(mesh, two_bumps(mesh, false)),
                           find_weight_regions(shuffled, two_bumps(shuffled, false))),
                1e-9);
    }

    TEST(WeightRegions, AreOneWithoutStrains)
    {
      const Mesh       mesh(long_bar);
      const PoseOfBody moved  = pose_of(mesh, "moved",
                                        [](const dealii::Point<3> &p)
                                        { return dealii::Point<3>(1. - p[1], 2. + p[0], p[2]); }),
                       longer = pose_of(mesh, "longer",
                                        [](const dealii::Point<3> &p)
                                        { return dealii::Point<3>(1.2 * p[0], p[1], p[2]); });
      for (const auto &poses :
           { std::vector<PoseOfBody>{}, std::vector<PoseOfBody>{ moved }, { moved, longer } })
      {
        const WeightRegions found = find_weight_regions(mesh, poses);
        ASSERT_EQ(found.regions.size(), 1u);
        EXPECT_TRUE(found.shares.empty());
        EXPECT_EQ(found.regions[0].n_cells, mesh.n_cells());
        EXPECT_NEAR(found.regions[0].volume, 1., 1e-12);
        EXPECT_EQ(found.regions[0].example, poses.size() == 2 ? "longer" : "");
      }
    }

    TEST(WeightRegions, PassIntoEachOtherOverALength)
    {
      const Mesh mesh(long_bar);
      const auto far = [&](const double length)
      {
        const WeightRegions found = find_weight_regions(mesh, two_bumps(mesh, true), length);
        double              least = 1.;
        for (const auto &of_region : found.shares)
          for (const double share : of_region)
            least = std::min(least, share);
        return least;
      };
      EXPECT_EQ(far(0.1), 0.);
      EXPECT_GT(far(1e3), 0.45);
    }
  } // namespace
} // namespace Exemplar::Testing
