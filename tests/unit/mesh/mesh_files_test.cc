// SPDX-License-Identifier: GPL-3.0-or-later
#include "expect_contains.h"
#include "meshes.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace Exemplar::Testing
{
  namespace
  {
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
                      "pose.msh is no pose of bar.msh: it has 6 nodes, the mesh has 5.");
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

    TEST_F(GeoTest, MakesADamagedMeshOfTheCacheAnew)
    {
      install_gmsh("cp '" + (directory / "made.msh").string() + "' \"$6\"\n");
      Mesh       mesh(parameters);
      const auto cached
          = std::filesystem::directory_iterator(directory / "cache dir" / "exemplar")->path();
      std::filesystem::resize_file(cached, std::filesystem::file_size(cached) / 2);
      EXPECT_EQ(Mesh(parameters).n_cells(), 2U);
      EXPECT_EQ(n_runs(), 2U);
      {
        std::fstream file(cached, std::ios::binary | std::ios::in | std::ios::out);
        file.seekp(70);
        file.put('7');
      }
      EXPECT_EQ(Mesh(parameters).n_cells(), 2U);
      EXPECT_EQ(n_runs(), 3U);
      EXPECT_EQ(Mesh(parameters).n_cells(), 2U);
      EXPECT_EQ(n_runs(), 3U);
      EXPECT_EQ(n_cached(), 1U);
    }

    TEST_F(GeoTest, RunsInAnEmptyDirectory)
    {
      install_gmsh("test -z \"$(ls | grep -v made)\" || exit 1; echo x > stray; cp '"
                   + (directory / "made.msh").string() + "' \"$6\"\n");
      EXPECT_EQ(Mesh(parameters).n_cells(), 2U);
      EXPECT_EQ(n_cached(), 1U);
      EXPECT_FALSE(std::filesystem::exists("stray"));
    }

    TEST_F(GeoTest, RunsNothingThatRunsCommandsUnlessAllowed)
    {
      install_gmsh("cp '" + (directory / "made.msh").string() + "' \"$6\"\n");
      std::ofstream(parameters.file) << "SystemCall \"true\";";
      expect_contains(error_of([&] { Mesh mesh(parameters); }), "the command SystemCall");
      EXPECT_EQ(n_runs(), 0U);
      parameters.allow_commands = true;
      for (unsigned int run = 1; run <= 2; ++run) // nobody knows what such a script does
      {
        EXPECT_EQ(Mesh(parameters).n_cells(), 2U);
        EXPECT_EQ(n_runs(), run);
      }
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
} // namespace Exemplar::Testing
