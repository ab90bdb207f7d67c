// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/private_directory.h>
#include <exemplar/base/sealed_file.h>
#include <exemplar/mesh/mesh_generation.h>
#include <exemplar/mesh/msh_comment.h>

#include "expect_contains.h"
#include "meshes.h"
#include "msh_bytes.h"

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

    class GeoTest : public MeshFilesTest
    {
    protected:
      GeoTest() : cache(directory / "cache dir" / "exemplar")
      {
        ::setenv("XDG_CACHE_HOME", cache.parent_path().c_str(), 1);
        parameters.file = write("it's a \"bar\" $(x).geo", box).string();
      }

      ~GeoTest() override
      {
        ::unsetenv("XDG_CACHE_HOME");
      }

      std::vector<std::filesystem::path>
      cached() const
      {
        std::vector<std::filesystem::path> files;
        if (std::filesystem::exists(cache))
          for (const auto &entry : std::filesystem::directory_iterator(cache))
            files.push_back(entry.path());
        return files;
      }

      /// Another mesh, of 2 cells, in the place of the one that is kept.
      void
      replace_cached() const
      {
        const auto kept = cached().at(0);
        std::ofstream(kept) << sealed(with_comment(msh_text(two_tetrahedra()), "seccomp"));
      }

      const std::string box
          = "SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 2, 1, 1}; Mesh.MeshSizeMin = 1;\n";
      const std::filesystem::path cache;
      MeshParameters              parameters;
    };

    TEST_F(GeoTest, MeshesOnceAndAgainAfterAChange)
    {
      const unsigned int n_cells = Mesh(parameters).n_cells();
      EXPECT_GT(n_cells, 2U);
      EXPECT_EQ(Mesh(parameters).get_name(), parameters.file);
      ASSERT_EQ(cached().size(), 1U);
      EXPECT_EQ(Mesh(parameters).n_cells(), n_cells);
      replace_cached();
      EXPECT_EQ(Mesh(parameters).n_cells(), 2U); // it was not meshed again
      std::ofstream(parameters.file) << box << "Mesh.MeshSizeMax = .4;";
      EXPECT_GT(Mesh(parameters).n_cells(), n_cells);
      EXPECT_EQ(cached().size(), 2U);
    }

    TEST_F(GeoTest, CommentsAndNamesMakeNoOtherMesh)
    {
      Mesh{ parameters };
      parameters.file = write("other name.geo", "// another comment\n" + box).string();
      Mesh{ parameters };
      EXPECT_EQ(cached().size(), 1U);
    }

    TEST_F(GeoTest, SaysWhyGmshFailed)
    {
      write("part.inc", "// of two lines\nPoint(1) = {;\n");
      std::ofstream(parameters.file) << "Include \"part.inc\";";
      const auto error = error_of([&] { Mesh mesh(parameters); });
      expect_contains(error, parameters.file + ": gmsh could not mesh it:\n  Error   : '");
      expect_contains(error, "part.inc', line 2: syntax error");
      EXPECT_TRUE(cached().empty());
      parameters.file = "nowhere.geo";
      expect_contains(error_of([&] { Mesh mesh(parameters); }),
                      "nowhere.geo cannot be opened (No such file");
    }

    TEST_F(GeoTest, SaysWhenGmshSaysTooMuch)
    {
      std::ofstream(parameters.file)
          << "For i In {1:1e9}\nPrintf(\"" << std::string(900, 'x') << "\");\nEndFor\n";
      expect_contains(error_of([&] { Mesh mesh(parameters); }),
                      "gmsh wrote more than 16 MiB of messages and was ended. Is there a loop");
    }

    TEST_F(GeoTest, MakesADamagedMeshOfTheCacheAnew)
    {
      const unsigned int n_cells = Mesh(parameters).n_cells();
      const auto         kept    = cached().at(0);
      std::filesystem::resize_file(kept, std::filesystem::file_size(kept) / 2);
      EXPECT_EQ(Mesh(parameters).n_cells(), n_cells);
      {
        std::fstream file(kept, std::ios::binary | std::ios::in | std::ios::out);
        file.seekp(70);
        file.put('7');
      }
      EXPECT_EQ(Mesh(parameters).n_cells(), n_cells);
      EXPECT_EQ(cached().size(), 1U);
    }

    TEST_F(GeoTest, DoesNotBelieveWhatOthersMayWrite)
    {
      const unsigned int n_cells = Mesh(parameters).n_cells();
      replace_cached();
      ::chmod(cache.c_str(), 0777);
      const Mesh mesh(parameters);
      EXPECT_EQ(mesh.n_cells(), n_cells);
      ASSERT_EQ(mesh.get_warnings().size(), 1U);
      expect_contains(mesh.get_warnings()[0], "may be written by others");
      ::chmod(cache.c_str(), 0700);
      EXPECT_EQ(Mesh(parameters).n_cells(), 2U);
    }

    TEST_F(GeoTest, RunsWithoutAPlaceToKeepMeshes)
    {
      ::setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
      const Mesh mesh(parameters);
      EXPECT_GT(mesh.n_cells(), 2U);
      ASSERT_EQ(mesh.get_warnings().size(), 1U);
      expect_contains(mesh.get_warnings()[0], "Set XDG_CACHE_HOME to a directory of your own");
    }

    TEST_F(GeoTest, RemovesWhatKilledProcessesHaveLeft)
    {
      std::filesystem::create_directories(cache / "making-abcdef");
      write("cache dir/exemplar/making-ghijkl", "half a mesh");
      write("cache dir/exemplar/made by hand", "");
      const int in_use = lock_in_use(write("cache dir/exemplar/making-in-use", ""));
      ::chmod(cache.c_str(), 0700);
      Mesh{ parameters };
      EXPECT_EQ(cached().size(), 3U);
      EXPECT_TRUE(std::filesystem::exists(cache / "making-in-use"));
      ::close(in_use);
    }

    TEST_F(GeoTest, RunsNothingThatRunsCommandsUnlessAllowed)
    {
      const auto trace = directory / "trace";
      std::ofstream(parameters.file) << box << "SystemCall \"touch " << trace.string() << "\";";
      expect_contains(error_of([&] { Mesh mesh(parameters); }), "the command SystemCall");
      EXPECT_FALSE(std::filesystem::exists(trace));
      parameters.allow_commands = true;
      for (unsigned int run = 1; run <= 2; ++run) // nobody knows what such a script does
      {
        EXPECT_GT(Mesh(parameters).n_cells(), 2U);
        EXPECT_TRUE(std::filesystem::remove(trace));
      }
      EXPECT_TRUE(cached().empty());
    }

    /// gmsh has other ways to its own numbers; this is what its program writes.
    TEST_F(GeoTest, MeshesAsGmshItself)
    {
      if (std::system("gmsh --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "the program gmsh is not installed";
      for (const std::string script :
           { "Physical Volume(5) = {1}; Physical Surface(\"left\") = {1, 3};",
             "Mesh.ElementOrder = 2; Physical Volume(\"a\", 5) = {1}; Physical Volume(6) = {1};",
             "Physical Volume(5) = {-1}; Physical Surface(2) = {-1, 3}; Physical Curve(1) = {-2};",
             "Physical Surface(7) = {1}; Physical Volume(5) = {1}; Mesh.SaveAll = 1;",
             "Mesh.ScalingFactor = 1e-3; Mesh 2; Physical Volume(5) = {1};", "" })
      {
        std::ofstream(parameters.file)
            << box << script << "\n"; // gmsh drops a line that has no end
        ASSERT_EQ(std::system(("cd '" + directory.string()
                               + "' && cp *bar*.geo itself.geo && "
                                 "gmsh -3 -format msh22 itself.geo -o itself.msh > /dev/null 2>&1")
                                  .c_str()),
                  0);
        MshFile made   = mesh_geo_file(parameters.file, false);
        made.geo_walls = {};
        EXPECT_TRUE(equal(made, read_msh(directory / "itself.msh"))) << script;
      }
    }

    TEST_F(GeoTest, MeshesWithGroups)
    {
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
