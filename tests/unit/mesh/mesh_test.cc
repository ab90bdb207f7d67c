// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/selection.h>

#include "expect_contains.h"
#include "meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(MeshTest, KeepsTheNumberingOfTheFile)
    {
      const Mesh mesh(two_tetrahedra(), "bar.msh");
      EXPECT_EQ(mesh.n_nodes(), 5U);
      EXPECT_EQ(mesh.n_cells(), 2U);
      EXPECT_TRUE(mesh.get_warnings().empty());
      EXPECT_EQ(mesh.get_material_ids(), (std::vector<unsigned int>{ 5, 6 }));
      EXPECT_DOUBLE_EQ(mesh.diameter(), std::sqrt(3.));

      const auto &triangulation = mesh.get_triangulation();
      EXPECT_EQ(triangulation.get_vertices(), mesh.get_nodes());
      unsigned int n_faces_with_id = 0;
      for (const auto &cell : triangulation.active_cell_iterators())
      {
        EXPECT_EQ(cell->material_id(), mesh.get_material_ids()[cell->active_cell_index()]);
        for (const auto v : cell->vertex_indices())
          EXPECT_EQ(cell->vertex_index(v), mesh.get_cells()[cell->active_cell_index()][v]);
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() != 0)
          {
            ++n_faces_with_id;
            EXPECT_EQ(face->boundary_id(), 7U);
            EXPECT_EQ(face->center()[2], 0.);
          }
      }
      EXPECT_EQ(n_faces_with_id, 1U);
    }

    TEST(MeshTest, FindsBoundaryFacesFacingOutwards)
    {
      const Mesh mesh(two_tetrahedra(), "bar.msh");
      EXPECT_EQ(mesh.get_boundary_faces().size(), 6U);
      const auto by_id = areas(mesh);
      EXPECT_NEAR((by_id.at(7) - dealii::Tensor<1, 3>({ 0., 0., -0.5 })).norm(), 0., 1e-15);
      EXPECT_NEAR((by_id.at(7) + by_id.at(0)).norm(), 0., 1e-15); // a closed surface
    }

    TEST(MeshTest, ReorientsNegativeTetrahedra)
    {
      MshFile msh = two_tetrahedra();
      std::swap(msh.elements[2].nodes[0], msh.elements[2].nodes[1]);
      const Mesh mesh(msh, "bar.msh");
      EXPECT_DOUBLE_EQ(total_volume(mesh), 0.5);
      EXPECT_EQ(mesh.get_contents().elements[2].nodes, msh.elements[2].nodes);
      ASSERT_EQ(mesh.get_warnings().size(), 1U);
      expect_contains(mesh.get_warnings()[0], "1 tetrahedra of negative volume");
      expect_contains(mesh.get_warnings()[0], "element 102.");
    }

    TEST(MeshTest, RefusesCellsThatAreInsideOut)
    {
      MshFile msh  = two_tetrahedra();
      msh.nodes[4] = { 0.1, 0.1, 0.05 }; // node 14 on the other side of the face to its neighbour
      expect_contains(error_of(msh), "1 of 2 tetrahedra are inside out");
      expect_contains(error_of(msh), "element 102.");
      for (auto &node : msh.nodes)
        node[0] = -node[0]; // in a mirrored mesh the wrong one has a positive volume
      expect_contains(error_of(msh), "inside out");

      msh = two_tetrahedra();
      for (auto &node : msh.nodes)
        node[0] = -node[0];
      EXPECT_EQ(error_of(msh), ""); // all cells are mirrored: only the order of nodes is another
    }

    TEST(MeshTest, RefusesAFlatMesh)
    {
      MshFile msh = two_tetrahedra();
      for (auto &node : msh.nodes)
        node[1] = 3.;
      expect_contains(error_of(msh), "the mesh is flat: y is 3 at all nodes");
    }

    TEST(MeshTest, RefusesOtherElements)
    {
      MshFile msh = two_tetrahedra();
      msh.elements.erase(msh.elements.begin() + 1, msh.elements.end());
      expect_contains(error_of(msh), "bar.msh: has no tetrahedra");
      msh.geo_walls = std::vector<std::string>();
      expect_contains(error_of(msh), "needs a Volume: Extrude a surface");

      for (const unsigned int type : { 3U, 5U, 6U, 7U, 9U, 11U })
      {
        msh                    = two_tetrahedra();
        const auto *const kind = find_msh_element_kind(type);
        for (std::size_t number = 201; number <= 207; ++number)
          msh.elements.push_back(
              { number, type, 1, 1, std::vector<std::size_t>(kind->n_nodes, 0) });
        expect_contains(error_of(msh), "element 201 is a " + std::string(kind->name));
        expect_contains(error_of(msh), "201, 202, 203, 204, 205 and 2 more");
      }
    }

    TEST(MeshTest, RefusesFlatTetrahedra)
    {
      MshFile msh = two_tetrahedra();
      // Node 14 in the plane of 11, 12, 13, up to a height that the tolerance decides on.
      const auto at_height = [&](const double height)
      {
        const double third = (1. + height) / 3.;
        msh.nodes[4]       = { third, third, third };
        return error_of(msh);
      };
      expect_contains(at_height(0.), "1 tetrahedron without volume");
      expect_contains(at_height(0.), "element 102.");
      EXPECT_NE(at_height(1e-12), "");
      EXPECT_EQ(at_height(1e-10), "");
      msh.nodes[4] = { 1e300, 1e300, 1e300 }; // overflows
      EXPECT_NE(error_of(msh), "");
      msh                   = two_tetrahedra();
      msh.elements[1].nodes = { 0, 1, 2, 2 };
      expect_contains(error_of(msh), "element 101.");
    }

    TEST(MeshTest, RefusesOrphanNodes)
    {
      MshFile msh = two_tetrahedra();
      add_node(msh, { 2., 2., 2. });
      add_node(msh, { 3., 2., 2. });
      expect_contains(error_of(msh), "2 nodes in no tetrahedron: node 15, 16.");
    }

    TEST(MeshTest, RefusesDuplicateTetrahedraAndTripleFaces)
    {
      MshFile msh = two_tetrahedra();
      msh.elements.push_back({ 103, tetrahedron, 6, 1, { 4, 1, 3, 2 } });
      expect_contains(error_of(msh), "tetrahedra 102 and 103 have the same nodes");

      msh = two_tetrahedra();
      add_node(msh, { 2., 2., 2. });
      msh.elements.push_back({ 103, tetrahedron, 6, 1, { 1, 2, 3, 5 } });
      expect_contains(error_of(msh), "face with the nodes 11, 12, 13 belongs to more than two");
      expect_contains(error_of(msh), "element 101, 102, 103.");
    }

    TEST(MeshTest, RefusesPartsLikeHingesAndCountsPieces)
    {
      // A third tetrahedron that shares 2, 1 or 0 nodes with the others.
      MshFile msh = two_tetrahedra();
      add_node(msh, { -1., 0., 0. });
      add_node(msh, { -1., 0., -1. });
      const MshFile edge_nodes = msh;
      msh.elements.push_back({ 103, tetrahedron, 0, 1, { 0, 2, 5, 6 } });
      expect_contains(error_of(msh),
                      "has 2 parts that no common face connects, beginning with element 101, 103.");
      expect_contains(error_of(msh), "touch only at an edge, like a hinge: node 10, 12.");

      msh = edge_nodes;
      add_node(msh, { -1., 1., -1. });
      const MshFile point_nodes = msh;
      msh.elements.push_back({ 103, tetrahedron, 0, 1, { 0, 5, 6, 7 } });
      expect_contains(error_of(msh), "touch only at a node, like a hinge: node 10.");

      msh = point_nodes;
      add_node(msh, { -2., 1., -1. });
      msh.elements.push_back({ 103, tetrahedron, 0, 1, { 5, 6, 7, 8 } });
      const Mesh mesh(msh, "bar.msh");
      EXPECT_EQ(mesh.n_pieces(), 2U);
      EXPECT_EQ(mesh.whole().pieces.first_elements, (std::vector<std::size_t>{ 101, 103 }));
      EXPECT_EQ(mesh.piece_of(1), 0U);
      EXPECT_EQ(mesh.piece_of(2), 1U);
      EXPECT_EQ(Mesh(two_tetrahedra(), "bar.msh").n_pieces(), 1U);
    }

    TEST(MeshTest, ChecksPhysicalTriangles)
    {
      MshFile msh = two_tetrahedra();
      msh.elements.push_back({ 51, triangle, 3, 1, { 0, 1, 4 } });
      expect_contains(error_of(msh), "no face of a tetrahedron: element 51.");
      msh.elements.back().physical = 0; // of no group: ignored
      EXPECT_EQ(error_of(msh), "");

      msh = two_tetrahedra();
      msh.elements.push_back({ 51, triangle, 3, 1, { 3, 1, 2 } });  // internal
      msh.elements.push_back({ 52, triangle, 9, 1, { 2, 1, 0 } });  // 50 again, other tag
      msh.elements.push_back({ 53, triangle, -7, 1, { 2, 1, 0 } }); // 50 again, same tag
      const Mesh mesh(msh, "bar.msh");
      EXPECT_TRUE(mesh.get_warnings().empty());
      ASSERT_EQ(mesh.get_further_faces().size(), 2U);
      EXPECT_EQ(mesh.get_further_faces()[0].boundary_id, 9U); // 7 comes first
      EXPECT_EQ(mesh.get_further_faces()[1].boundary_id, 3U);
      EXPECT_EQ((Selection{ "boundary 3" }.nodes(mesh, "Select")),
                (std::vector<unsigned int>{ 1, 2, 3 }));
      EXPECT_EQ((Selection{ "boundary 9" }.nodes(mesh, "Select")),
                (std::vector<unsigned int>{ 0, 1, 2 }));
      EXPECT_DOUBLE_EQ(areas(mesh).at(7).norm(), 0.5);
      EXPECT_EQ(areas(mesh).size(), 2U);
    }
  } // namespace
} // namespace Exemplar::Testing
