// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/key_table.h>

#include "expect_contains.h"
#include "meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(BoxTest, HasTheSizeAndIdsThatItSays)
    {
      const Mesh mesh(small_box());
      EXPECT_EQ(mesh.get_name(), "box");
      EXPECT_EQ(mesh.n_cells(), 6U * 3 * 1 * 2);
      EXPECT_EQ(mesh.n_nodes(), 4U * 2 * 3);
      EXPECT_TRUE(mesh.get_warnings().empty());
      EXPECT_NEAR(total_volume(mesh), 8., 1e-14);
      EXPECT_EQ(
          std::set<unsigned int>(mesh.get_material_ids().begin(), mesh.get_material_ids().end()),
          std::set<unsigned int>{ 1 });

      EXPECT_EQ(mesh.get_nodes().front(), dealii::Point<3>(0., -0.5, -1.));
      EXPECT_NEAR(mesh.get_nodes()[1].distance({ 4. / 3., -0.5, -1. }), 0., 1e-15);
      EXPECT_EQ(mesh.get_nodes()[4], dealii::Point<3>(0., 0.5, -1.));
      EXPECT_EQ(mesh.get_nodes().back(), dealii::Point<3>(4., 0.5, 1.));
      EXPECT_EQ(mesh.get_contents().node_numbers.front(), 1U);

      const double expected[6][3] = { { -2., 0., 0. }, { 2., 0., 0. },  { 0., -8., 0. },
                                      { 0., 8., 0. },  { 0., 0., -4. }, { 0., 0., 4. } };
      const auto   by_id          = areas(mesh);
      EXPECT_EQ(by_id.size(), 6U); // so no face is without an id: the mesh conforms
      for (unsigned int id = 1; id <= 6; ++id)
        for (unsigned int d = 0; d < 3; ++d)
          EXPECT_NEAR(by_id.at(id)[d], expected[id - 1][d], 1e-14) << id;
      EXPECT_EQ(mesh.get_boundary_faces().size(), 2U * 2 * (3 * 1 + 1 * 2 + 3 * 2));
    }

    TEST(BoxTest, WritesOutwardTriangles)
    {
      const Mesh     mesh(small_box());
      const MshFile &box = mesh.get_contents();
      for (const auto &element : box.elements)
        if (element.type == triangle)
        {
          const auto &x    = box.nodes;
          const auto  n    = dealii::cross_product_3d(x[element.nodes[1]] - x[element.nodes[0]],
                                                      x[element.nodes[2]] - x[element.nodes[0]]);
          const auto  axis = static_cast<unsigned int>(element.physical - 1) / 2;
          EXPECT_GT(element.physical % 2 == 0 ? n[axis] : -n[axis], 0.);
        }
    }

    TEST(BoxTest, RefusesBadParameters)
    {
      const auto error_with = [](const std::function<void(MeshParameters &)> &change)
      {
        MeshParameters parameters = small_box();
        change(parameters);
        return error_of([&] { Mesh mesh(parameters); });
      };
      expect_contains(error_with([](auto &p) { p.generator = MeshGenerator::none; }),
                      "no mesh is given. Set Mesh/File");
      expect_contains(error_with([](auto &p) { p.file = "bar.msh"; }), "both File and Generator");
      expect_contains(error_with([](auto &p) { p.scale = 0.; }), "Mesh/Scale");
      expect_contains(error_with([](auto &p) { p.box_size[1] = 0.; }), "Mesh/Box size");
      expect_contains(error_with([](auto &p) { p.box_cells[2] = 0; }), "Mesh/Box cells");
      expect_contains(error_with(
                          [](auto &p) {
                            p.box_cells = { { 4000000000U, 4000000000U, 1 } };
                          }),
                      "more than 1e9");
    }

    TEST(MeshParametersTest, ReadsItsKeys)
    {
      MeshParameters parameters;
      KeyTable       keys;
      parameters.declare(keys);
      const auto apply = [&](const std::string &text)
      { keys.apply(read_assignments("subsection Mesh\n" + text + "end\n", "scene.prm"), ""); };
      apply(" set Generator = box\n set Box size = 4, 1, 2\n"
            " set Box cells = 3, 1, 2\n set Scale = 0.5\n");
      EXPECT_TRUE(parameters.generator == MeshGenerator::box);
      EXPECT_EQ(parameters.box_size, small_box().box_size);
      EXPECT_EQ(parameters.box_cells, small_box().box_cells);
      EXPECT_EQ(parameters.scale, 0.5);
      EXPECT_NEAR(total_volume(Mesh(parameters)), 1., 1e-14);
      expect_contains(error_of([&] { apply("set Box cells = 3, 0, 2\n"); }),
                      "Allowed: three integers >= 1 separated by commas");
    }
  } // namespace
} // namespace Exemplar::Testing
