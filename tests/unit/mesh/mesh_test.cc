// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/prm/key_table.h>

#include <deal.II/grid/tria_accessor.h>
#include <deal.II/grid/tria_iterator.h>

#include "expect_contains.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int triangle    = MshElementType::triangle;
    constexpr unsigned int tetrahedron = MshElementType::tetrahedron;

    std::string
    error_of(const std::function<void()> &action)
    {
      try
      {
        action();
        return "";
      }
      catch (const UserError &error)
      {
        return error.what();
      }
    }

    std::string
    error_of(const MshFile &contents)
    {
      return error_of([&] { Mesh mesh(contents, "bar.msh"); });
    }

    /// Two positive tetrahedra on a common face 1, 2, 3. Node i has the number
    /// 10 + i; elements 101 (tag 5) and 102 (tag -6), triangle 50 (tag 7).
    MshFile
    two_tetrahedra()
    {
      MshFile msh;
      msh.node_numbers = { 10, 11, 12, 13, 14 };
      msh.nodes
          = { { 0., 0., 0. }, { 1., 0., 0. }, { 0., 1., 0. }, { 0., 0., 1. }, { 1., 1., 1. } };
      msh.elements = { { 50, triangle, 7, 1, { 0, 1, 2 } },
                       { 101, tetrahedron, 5, 1, { 0, 1, 2, 3 } },
                       { 102, tetrahedron, -6, 1, { 1, 2, 3, 4 } } };
      return msh;
    }

    void
    add_node(MshFile &msh, const dealii::Point<3> &point)
    {
      msh.node_numbers.push_back(10 + msh.nodes.size());
      msh.nodes.push_back(point);
    }

    double
    signed_volume(const Mesh &mesh, const std::array<unsigned int, 4> &cell)
    {
      const auto &x = mesh.get_nodes();
      return (x[cell[1]] - x[cell[0]])
             * dealii::cross_product_3d(x[cell[2]] - x[cell[0]], x[cell[3]] - x[cell[0]]) / 6.;
    }

    double
    total_volume(const Mesh &mesh)
    {
      double volume = 0.;
      for (const auto &cell : mesh.get_cells())
      {
        EXPECT_GT(signed_volume(mesh, cell), 0.);
        volume += signed_volume(mesh, cell);
      }
      return volume;
    }

    /// Area vector, outwards, of each boundary id.
    std::map<unsigned int, dealii::Tensor<1, 3>>
    areas(const Mesh &mesh)
    {
      std::map<unsigned int, dealii::Tensor<1, 3>> result;
      const auto                                  &x = mesh.get_nodes();
      for (const auto &face : mesh.get_boundary_faces())
        result[face.boundary_id] += 0.5
                                    * dealii::cross_product_3d(x[face.nodes[1]] - x[face.nodes[0]],
                                                               x[face.nodes[2]] - x[face.nodes[0]]);
      return result;
    }

    MeshParameters
    small_box()
    {
      MeshParameters parameters;
      parameters.generator = MeshGenerator::box;
      parameters.box_size  = { { 4., 1., 2. } };
      parameters.box_cells = { { 3, 1, 2 } };
      return parameters;
    }

    class MeshFilesTest : public Testing::InTemporaryDirectory
    {
    protected:
      std::filesystem::path
      write(const std::string &name, const std::string &text) const
      {
        return write_file(name, text);
      }
    };

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

    TEST(MeshTest, RefusesOtherElements)
    {
      MshFile msh = two_tetrahedra();
      msh.elements.erase(msh.elements.begin() + 1, msh.elements.end());
      expect_contains(error_of(msh), "bar.msh: has no tetrahedra");

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

    TEST(MeshTest, RefusesSeveralParts)
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
      expect_contains(error_of(msh), "They have no node in common.");
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
      ASSERT_EQ(mesh.get_warnings().size(), 2U);
      expect_contains(mesh.get_warnings()[0],
                      "between two tetrahedra have no boundary id: element 51.");
      expect_contains(mesh.get_warnings()[1], "that of element 52.");
      EXPECT_DOUBLE_EQ(areas(mesh).at(7).norm(), 0.5);
      EXPECT_EQ(areas(mesh).size(), 2U);
    }

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

    TEST_F(MeshFilesTest, PosesComeBackBitwise)
    {
      const Mesh mesh(small_box());
      auto       positions = mesh.get_nodes();
      for (auto &x : positions)
        x = { std::sin(x[0]) / 3., x[1] + 0.1 * x[0] * x[0], x[2] / 7. };
      mesh.write_pose(positions, directory / "final.msh");
      EXPECT_EQ(mesh.read_pose(directory / "final.msh"), positions);
      EXPECT_EQ(read_msh(directory / "final.msh").elements.size(),
                mesh.get_contents().elements.size());
    }

    TEST_F(MeshFilesTest, ScalesMeshAndPosesAlike)
    {
      write_msh(two_tetrahedra(), directory / "bar.msh");
      MeshParameters parameters;
      parameters.file  = (directory / "bar.msh").string();
      parameters.scale = 0.125;
      const Mesh mesh(parameters);
      EXPECT_EQ(mesh.get_name(), parameters.file);
      EXPECT_EQ(mesh.get_nodes()[4], dealii::Point<3>(0.125, 0.125, 0.125));
      EXPECT_EQ(mesh.read_pose(parameters.file), mesh.get_nodes());
      mesh.write_pose(mesh.get_nodes(), directory / "pose.msh");
      EXPECT_EQ(read_msh(directory / "pose.msh").nodes, two_tetrahedra().nodes);
    }

    TEST_F(MeshFilesTest, RefusesPosesOfOtherMeshes)
    {
      const Mesh mesh(two_tetrahedra(), "bar.msh");
      const auto error_with = [&](const std::function<void(MshFile &)> &change)
      {
        MshFile pose = two_tetrahedra();
        change(pose);
        write_msh(pose, directory / "pose.msh");
        return error_of([&] { mesh.read_pose(directory / "pose.msh"); });
      };
      EXPECT_EQ(error_with([](auto &p) { p.nodes[0] = { 9., 9., 9. }; }), "");
      EXPECT_EQ(error_with([](auto &p) { p.elements.erase(p.elements.begin()); }), "");
      expect_contains(error_with([](auto &p) { add_node(p, {}); }),
                      "pose.msh is no pose of bar.msh: has 6 nodes, the mesh has 5.");
      expect_contains(error_with([](auto &p) { p.node_numbers[3] = 99; }),
                      "the node at position 4 has the number 99, in the mesh 13.");
      expect_contains(error_with([](auto &p) { p.elements.pop_back(); }),
                      "has 1 tetrahedra, the mesh has 2.");
      const auto swapped = error_with([](auto &p) { std::swap(p.elements[1], p.elements[2]); });
      expect_contains(swapped,
                      "tetrahedron 1 (element 102) has the nodes 11, 12, 13, 14, in the mesh "
                      "(element 101) 10, 11, 12, 13.");
      expect_contains(swapped, "final.msh that exemplar wrote for this same mesh");
    }

    /// gmsh is replaced by a script that counts its runs, so that these tests need
    /// no gmsh and see when it is called.
    class GeoTest : public MeshFilesTest
    {
    protected:
      GeoTest() : path(std::getenv("PATH"))
      {
        std::filesystem::create_directories(directory / "bin");
        ::setenv("XDG_CACHE_HOME", (directory / "cache dir").c_str(), 1);
        ::setenv("PATH", ((directory / "bin").string() + ":" + path).c_str(), 1);
        write_msh(two_tetrahedra(), directory / "made.msh");
        parameters.file = write("it's a \"bar\" $(x).geo", "// geometry").string();
      }

      ~GeoTest() override
      {
        ::setenv("PATH", path.c_str(), 1);
        ::unsetenv("XDG_CACHE_HOME");
      }

      void
      install_gmsh(const std::string &meshing) const
      {
        const auto script = write(
            "bin/gmsh", "#!/bin/sh\nif [ \"$1\" = --version ]; then echo 4.8.4 >&2; exit 0; fi\n"
                        "echo run >> '"
                            + (directory / "runs").string() + "'\n" + meshing);
        ::chmod(script.c_str(), 0755);
      }

      std::size_t
      n_runs() const
      {
        std::ifstream in(directory / "runs");
        return static_cast<std::size_t>(
            std::count(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>(), '\n'));
      }

      std::size_t
      n_cached() const
      {
        const std::filesystem::directory_iterator files(directory / "cache dir" / "exemplar");
        return static_cast<std::size_t>(std::distance(begin(files), end(files)));
      }

      std::string    path;
      MeshParameters parameters;
    };

    TEST_F(GeoTest, MeshesOnceAndAgainAfterAChange)
    {
      // Arguments: -3 FILE -format msh22 -o OUT
      install_gmsh("test -f \"$2\" && cp '" + (directory / "made.msh").string() + "' \"$6\"\n");
      for (unsigned int i = 0; i < 2; ++i)
        EXPECT_EQ(Mesh(parameters).get_name(), parameters.file);
      EXPECT_EQ(n_runs(), 1U);
      std::ofstream(parameters.file) << "// another geometry";
      EXPECT_EQ(Mesh(parameters).n_cells(), 2U);
      EXPECT_EQ(n_runs(), 2U);
      EXPECT_EQ(n_cached(), 2U);
    }

    TEST_F(GeoTest, SaysWhyGmshFailed)
    {
      for (const std::string end : { "exit 1", "exit 0" })
      {
        install_gmsh("echo half > \"$6\"; echo 'Error   : line 1: syntax error' >&2; echo Info\n"
                     + end);
        const auto error = error_of([&] { Mesh mesh(parameters); });
        expect_contains(error, parameters.file
                                   + ": gmsh could not mesh it:\n  Error   : line 1: syntax error");
        EXPECT_EQ(n_cached(), 0U);
      }
      ::setenv("PATH", (directory / "made.msh").c_str(), 1);
      expect_contains(error_of([&] { Mesh mesh(parameters); }),
                      "Install the package gmsh, or mesh it elsewhere");
      parameters.file = "nowhere.geo";
      expect_contains(error_of([&] { Mesh mesh(parameters); }),
                      "nowhere.geo cannot be opened (No such file");
    }

    TEST_F(GeoTest, MeshesWithTheRealGmsh)
    {
      if (std::system("gmsh --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "gmsh is not installed";
      std::ofstream(parameters.file)
          << "SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 2, 1, 1};\n"
             "Physical Volume(5) = {1}; Physical Surface(7) = {1}; Mesh.CharacteristicLengthMin = "
             "1;\n";
      const Mesh mesh(parameters);
      EXPECT_NEAR(total_volume(mesh), 2., 1e-12);
      EXPECT_NEAR((areas(mesh).at(7) - dealii::Tensor<1, 3>({ -1., 0., 0. })).norm(), 0., 1e-12);
    }
  } // namespace
} // namespace Exemplar
