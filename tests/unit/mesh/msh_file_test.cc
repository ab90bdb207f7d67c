// SPDX-License-Identifier: GPL-3.0-or-later
#include "expect_contains.h"
#include "msh_bytes.h"

#include <exemplar/mesh/mesh_inputs.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>

namespace Exemplar::Testing
{
  namespace
  {
    using MshFileTest = MshTest;

    TEST_F(MshFileTest, ReadsAllFormats)
    {
      for (const std::string &bytes : all_formats())
        EXPECT_TRUE(equal(read(bytes), two_tetrahedra_with_gaps())) << bytes;
    }

    TEST_F(MshFileTest, WritesBackBitwise)
    {
      MshFile msh = two_tetrahedra_with_gaps();
      for (unsigned int i = 0; i < 100; ++i)
      {
        msh.node_numbers.push_back(200000 + 3 * i);
        msh.nodes.emplace_back(std::sin(i), std::exp(10. * i - 500.), -1. / (3. + i));
      }
      msh.elements.push_back({ 99, 31, -4, 1, std::vector<std::size_t>(56, 3) }); // a long line
      write_msh(msh, directory / "copy.msh");
      EXPECT_TRUE(equal(read_msh(directory / "copy.msh"), msh));
      EXPECT_FALSE(std::filesystem::exists(directory / "copy.msh.tmp"));
    }

    TEST_F(MshFileTest, TiesOfTheSurfaceGoByNodeNumbers)
    {
      MshFile mesh           = make_msh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
                                        { { { 0, 1, 2, 3 } } });
      mesh.node_numbers      = { 7, 3, 9, 5 };
      mesh.surface_ties      = { { { { 1, 0, 3, 2 } }, { { .1, .2, .3, .4 } } },
                                 { { { 2, 2, 2, 2 } }, { { 1., 0., 0., 0. } } } };
      const std::string text = msh_text(mesh);
      EXPECT_NE(
          text.find("$SurfaceTies\n2\n3 7 5 9 0.1 0.2 0.3 0.4\n9 9 9 9 1 0 0 0\n$EndSurfaceTies\n"),
          std::string::npos);
      const MshFile read = read_msh_bytes(text, "tied.msh");
      ASSERT_EQ(read.surface_ties.size(), 2u);
      EXPECT_EQ(read.surface_ties[0].nodes, mesh.surface_ties[0].nodes);
      EXPECT_EQ(read.surface_ties[0].shares, mesh.surface_ties[0].shares);
      for (const auto &[from, to] : std::map<std::string, std::string>{
               { "3 7 5 9", "3 8 5 9" }, { "0.1 0.2", "0.1 0.7" }, { "0.1 0.2", "0.1 nan" } })
      {
        std::string bad = text;
        bad.replace(bad.find(from), from.size(), to);
        EXPECT_THROW(read_msh_bytes(bad, "bad.msh"), UserError) << to;
      }
    }

    TEST_F(MshFileTest, WritesGmshSyntax)
    {
      MshFile msh;
      msh.node_numbers = { 7 };
      msh.nodes        = { { 0.5, 0.1, -2. } };
      msh.elements     = { { 3, 15, 1, 2, { 0 } } };
      write_msh(msh, directory / "point.msh");
      std::ostringstream text;
      text << std::ifstream(directory / "point.msh").rdbuf();
      EXPECT_EQ(text.str(), "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                            "$Nodes\n1\n7 0.5 0.10000000000000001 -2\n$EndNodes\n"
                            "$Elements\n1\n3 15 2 1 2 7\n$EndElements\n");
    }

    TEST_F(MshFileTest, ReadsOtherElementsAndLineEnds)
    {
      std::string file
          = replaced(version_2(two_tetrahedra_with_gaps(), false), "20 4 3 9 1 77 7 12 100000 3",
                     "20 11 0 7 12 100000 3 7 12 100000 3 40 7");
      for (auto at = file.find('\n'); at != std::string::npos; at = file.find('\n', at + 2))
        file.insert(at, "\r");
      const MshFile msh = read(file);
      EXPECT_EQ(msh.elements.back().nodes.size(), find_msh_element_kind(11)->n_nodes);
      EXPECT_EQ(msh.elements.back().physical, 0);
      EXPECT_EQ(msh.physical_names, two_tetrahedra_with_gaps().physical_names);
      EXPECT_EQ(find_msh_element_kind(0), nullptr);
      EXPECT_EQ(find_msh_element_kind(32), nullptr);
      EXPECT_STREQ(find_msh_element_kind(29)->name, "20-node tetrahedron");
    }

    TEST_F(MshFileTest, ReadsWhatGmshWrites)
    {
      if (std::system("gmsh --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "gmsh is not installed";
      const auto geo
          = write("SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 1, 1, 1};\n"
                  "Physical Volume(\"body\", 5) = {1}; Physical Surface(\"skin\", 7) = {1, 2};\n",
                  "cube.geo");
      std::vector<MshFile> files;
      for (const char *const format : { "msh22", "msh22 -bin", "msh41", "msh41 -bin",
                                        "msh41 -setnumber Mesh.SaveParametric 1" })
      {
        const auto        msh     = directory / (std::to_string(files.size()) + ".msh");
        const std::string command = "gmsh -3 '" + geo.string() + "' -o '" + msh.string()
                                    + "' -format " + format + " > /dev/null 2>&1";
        ASSERT_EQ(std::system(command.c_str()), 0) << command;
        files.push_back(read_msh(msh));
      }
      // 2.2 and 4.1 differ in the order of elements and in the last digit of nodes.
      EXPECT_GT(files[0].elements.size(), 10U);
      EXPECT_EQ(files[0].physical_names.size(), 2U);
      EXPECT_TRUE(equal(files[2], files[4]));
      for (const MshFile &msh : files)
      {
        EXPECT_EQ(msh.node_numbers, files[0].node_numbers);
        EXPECT_EQ(msh.physical_names, files[0].physical_names);
        ASSERT_EQ(msh.elements.size(), files[0].elements.size());
        for (const auto &element : msh.elements)
          EXPECT_EQ(element.physical, element.type == MshElementType::tetrahedron ? 5 : 7);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
