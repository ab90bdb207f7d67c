// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_edges.h>
#include <exemplar/mesh/quadratic_msh.h>

#include "expect_contains.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// Two tetrahedra and a triangle between five nodes, whose numbers have gaps.
    MshFile
    two_linear()
    {
      MshFile msh;
      msh.node_numbers = { 17, 3, 101, 8, 44 };
      msh.nodes
          = { { 0., 0., 0. }, { 1., 0., 0. }, { 0., 1., 0. }, { 0., 0., 1. }, { 1., 1., 1. } };
      msh.elements = {
        { 7, MshElementType::triangle, 5, 5, { 0, 2, 1 } },
        { 9, MshElementType::tetrahedron, 1, 1, { 0, 1, 2, 3 } },
        { 2, MshElementType::tetrahedron, 1, 1, { 4, 2, 1, 3 } },
        { 4, MshElementType::line, 6, 6, { 0, 4 } }, // no edge of a tetrahedron
      };
      return msh;
    }

    std::vector<std::array<unsigned int, 2>>
    edges_of_two()
    {
      return edges_of({ { { 0, 1, 2, 3 } }, { { 4, 2, 1, 3 } } });
    }

    /// Nodes, then a place for each edge that is off its middle by `curve`.
    std::vector<dealii::Point<3>>
    places_of(const MshFile &msh, const double curve)
    {
      std::vector<dealii::Point<3>> places = msh.nodes;
      for (const auto &[a, b] : edges_of_two())
        places.push_back(msh.nodes[a] + 0.5 * (msh.nodes[b] - msh.nodes[a])
                         + dealii::Tensor<1, 3>({ curve * a, curve, 0. }));
      return places;
    }

    std::string
    error_of_pose(const MshFile &pose)
    {
      try
      {
        quadratic_pose(pose, two_linear(), "pose: ");
      }
      catch (const UserError &error)
      {
        return error.what();
      }
      return "";
    }

    TEST(QuadraticMsh, APoseComesBackAsItWas)
    {
      const MshFile msh    = two_linear();
      const auto    places = places_of(msh, 0.1);
      const MshFile pose   = with_middles(msh, edges_of_two(), places);
      EXPECT_EQ(pose.node_numbers[5], 102u);
      EXPECT_EQ(pose.elements[0].type, MshElementType::quadratic_triangle);
      EXPECT_EQ(pose.elements[2].type, MshElementType::quadratic_tetrahedron);
      EXPECT_EQ(pose.elements[3].type, MshElementType::line);
      EXPECT_EQ(pose.elements[2].nodes.size(), 10u);
      EXPECT_EQ(quadratic_pose(pose, msh, "pose: "), places);
    }

    TEST(QuadraticMsh, FurtherNodesOfAPoseMayHaveAnyNumbersAndPlaces)
    {
      const MshFile msh  = two_linear();
      MshFile       pose = with_middles(msh, edges_of_two(), places_of(msh, 0.1));
      std::reverse(pose.nodes.begin(), pose.nodes.end());
      std::reverse(pose.node_numbers.begin(), pose.node_numbers.end());
      for (MshElement &element : pose.elements)
        for (std::size_t &node : element.nodes)
          node = pose.nodes.size() - 1 - node;
      EXPECT_EQ(quadratic_pose(pose, msh, "pose: "), places_of(msh, 0.1));
    }

    TEST(QuadraticMsh, OtherPosesAreRefused)
    {
      const MshFile msh   = two_linear();
      const MshFile right = with_middles(msh, edges_of_two(), places_of(msh, 0.));
      MshFile       pose  = right;
      std::swap(pose.elements[1], pose.elements[2]);
      expect_contains(error_of_pose(pose), "corner 1 of tetrahedron 1 (element 2) is node 44");
      pose = right;
      pose.elements.erase(pose.elements.begin() + 1);
      expect_contains(error_of_pose(pose), "has 1 10-node tetrahedra, the mesh has 2");
      pose = right;
      pose.nodes.push_back(pose.nodes.back());
      pose.node_numbers.push_back(500);
      pose.elements[2].nodes[5] = pose.nodes.size() - 1; // between corners 1 and 2
      expect_contains(error_of_pose(pose),
                      "edge between nodes 3 and 101 has two nodes in its middle");
    }

    TEST(QuadraticMsh, CornersOfStraightEdgesAreTaken)
    {
      const MshFile msh  = two_linear();
      MshFile       file = with_middles(msh, edges_of_two(), places_of(msh, 0.));
      take_corners(file, "ten.msh");
      EXPECT_EQ(file.node_numbers, msh.node_numbers);
      EXPECT_EQ(file.nodes, msh.nodes);
      for (std::size_t e = 0; e < msh.elements.size(); ++e)
      {
        EXPECT_EQ(file.elements[e].type, msh.elements[e].type);
        EXPECT_EQ(file.elements[e].nodes, msh.elements[e].nodes);
      }
      expect_contains(file.note, "ten.msh");
      expect_contains(file.note, "Model/Element = P2");
      file = with_middles(msh, edges_of_two(), places_of(msh, 1e-5));
      EXPECT_THROW(take_corners(file, "ten.msh"), UserError);
    }
  } // namespace
} // namespace Exemplar::Testing
