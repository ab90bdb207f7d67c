// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/msh_file.h>

#include "expect_contains.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    class MshFileTest : public Testing::InTemporaryDirectory
    {
    protected:
      std::filesystem::path
      write(const std::string &bytes, const std::string &name = "mesh.msh") const
      {
        return write_file(name, bytes);
      }

      MshFile
      read(const std::string &bytes) const
      {
        return read_msh(write(bytes));
      }

      /// The message of the UserError that reading gives, "" if there is none.
      std::string
      error_of(const std::string &bytes) const
      {
        try
        {
          read(bytes);
          return "";
        }
        catch (const UserError &error)
        {
          return error.what();
        }
      }
    };

    /// Two tetrahedra, a physical triangle, a line and a point; node numbers have
    /// gaps and no order.
    MshFile
    two_tetrahedra_with_gaps()
    {
      MshFile msh;
      msh.node_numbers = { 40, 7, 12, 100000, 3 };
      msh.nodes        = {
               { 0., 0., 0. }, { 1. / 3., 0., 0. }, { 0., 0.1, 0. }, { 0., 0., 1e-17 }, { -0., 2., 7e300 }
      };
      msh.elements       = { { 11, 15, 0, 5, { 0 } },
                             { 12, 1, 6, 3, { 0, 1 } },
                             { 5, 2, 8, 2, { 0, 1, 2 } },
                             { 21, 4, 9, 1, { 0, 1, 2, 3 } },
                             { 20, 4, 9, 1, { 1, 2, 3, 4 } } };
      msh.physical_names = { { { 2, 8 }, "left \"end\"" }, { { 3, 9 }, "" } };
      return msh;
    }

    bool
    same_element(const MshElement &a, const MshElement &b)
    {
      return a.number == b.number && a.type == b.type && a.physical == b.physical
             && a.elementary == b.elementary && a.nodes == b.nodes;
    }

    bool
    equal(const MshFile &a, const MshFile &b)
    {
      bool same = a.node_numbers == b.node_numbers && a.nodes.size() == b.nodes.size()
                  && a.physical_names == b.physical_names
                  && std::equal(a.elements.begin(), a.elements.end(), b.elements.begin(),
                                b.elements.end(), same_element);
      for (std::size_t i = 0; same && i < a.nodes.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d) // bitwise: -0. is not 0.
          same = same && std::memcmp(&a.nodes[i][d], &b.nodes[i][d], sizeof(double)) == 0;
      return same;
    }

    /// Numbers as text with blanks or as bytes.
    class Numbers
    {
    public:
      explicit Numbers(const bool as_binary) : binary(as_binary)
      {
        out.precision(17);
      }

      template <typename Number>
      Numbers &
      operator<<(const Number &value)
      {
        if (binary)
          out.write(reinterpret_cast<const char *>(&value), sizeof(Number));
        else
          out << value << ' ';
        return *this;
      }

      Numbers &
      line()
      {
        if (!binary)
          out << '\n';
        return *this;
      }

      std::string
      str() const
      {
        return out.str();
      }

    private:
      bool               binary;
      std::ostringstream out;
    };

    std::string
    section(const std::string &name, const std::string &body)
    {
      return "$" + name + "\n" + body + (body.empty() || body.back() != '\n' ? "\n" : "") + "$End"
             + name + "\n";
    }

    std::string
    header(const std::string &version, const bool binary)
    {
      const int one = 1;
      return section("MeshFormat",
                     version + (binary ? " 1 8\n" : " 0 8\n")
                         + (binary ? std::string(reinterpret_cast<const char *>(&one), 4) : ""))
             + section("PhysicalNames", "2\n2 8 \"left \"end\"\"\n3 9 \"\"\n")
             + section("Comments", "$Nodes are further down");
    }

    /// What gmsh writes as version 2.2, by its documentation.
    std::string
    version_2(const MshFile &msh, const bool binary)
    {
      Numbers nodes(binary), elements(binary);
      for (std::size_t i = 0; i < msh.nodes.size(); ++i)
        (nodes << static_cast<int>(msh.node_numbers[i]) << msh.nodes[i][0] << msh.nodes[i][1]
               << msh.nodes[i][2])
            .line();
      for (const auto &e : msh.elements)
      {
        const int number = static_cast<int>(e.number);
        const int type   = static_cast<int>(e.type);
        if (binary)
          elements << type << 1 << 3 << number;
        else
          elements << number << type << 3;
        elements << e.physical << e.elementary << 77; // a third tag, to be skipped
        for (const auto n : e.nodes)
          elements << static_cast<int>(msh.node_numbers[n]);
        elements.line();
      }
      return header("2.2", binary)
             + section("Nodes", std::to_string(msh.nodes.size()) + "\n" + nodes.str())
             + section("Elements", std::to_string(msh.elements.size()) + "\n" + elements.str());
    }

    std::string
    entities(const bool binary)
    {
      using size = std::size_t;
      Numbers n(binary);
      (n << size(1) << size(1) << size(1) << size(1)).line();
      (n << 5 << 0. << 0. << 0. << size(0)).line();
      const auto box = [&](const int tag) { n << tag << 0. << 0. << 0. << 1. << 1. << 1.; };
      box(3);
      (n << size(1) << 6 << size(2) << 5 << -5).line();
      box(2);
      (n << size(2) << 8 << 1 << size(1) << 3).line(); // two physical groups
      box(1);
      (n << size(1) << 9 << size(1) << 2).line();
      return section("Entities", n.str());
    }

    /// Version 4.1; the first two nodes in a block with parameters on a surface.
    std::string
    version_4(const MshFile &msh, const bool binary)
    {
      using size = std::size_t;
      Numbers nodes(binary), elements(binary);
      (nodes << size(2) << msh.nodes.size() << size(3) << size(100000)).line();
      for (const bool on_surface : { true, false })
      {
        const size begin = on_surface ? 0 : 2;
        const size end   = on_surface ? 2 : msh.nodes.size();
        (nodes << (on_surface ? 2 : 3) << 1 << (on_surface ? 1 : 0) << end - begin).line();
        for (size i = begin; i < end; ++i)
          (nodes << msh.node_numbers[i]).line();
        for (size i = begin; i < end; ++i)
        {
          nodes << msh.nodes[i][0] << msh.nodes[i][1] << msh.nodes[i][2];
          if (on_surface)
            nodes << 0.25 << 0.75;
          nodes.line();
        }
      }
      (elements << msh.elements.size() << msh.elements.size() << size(5) << size(21)).line();
      for (const auto &e : msh.elements)
      {
        const int dimension = (e.type == 15) ? 0 : (e.type == 4) ? 3 : static_cast<int>(e.type);
        (elements << dimension << e.elementary << static_cast<int>(e.type) << size(1)).line();
        elements << e.number;
        for (const auto n : e.nodes)
          elements << msh.node_numbers[n];
        elements.line();
      }
      return header("4.1", binary) + entities(binary) + section("Nodes", nodes.str())
             + section("Elements", elements.str());
    }

    /// The same mesh in all four formats.
    std::vector<std::string>
    all_formats()
    {
      const MshFile msh = two_tetrahedra_with_gaps();
      return { version_2(msh, false), version_2(msh, true), version_4(msh, false),
               version_4(msh, true) };
    }

    std::string
    replaced(std::string text, const std::string &what, const std::string &by)
    {
      const auto at = text.find(what);
      EXPECT_NE(at, std::string::npos) << what;
      return text.replace(at, what.size(), by);
    }

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

    TEST_F(MshFileTest, RefusesEveryTruncation)
    {
      for (const std::string &bytes : all_formats())
        for (std::size_t n = 0; n + 1 < bytes.size(); ++n) // the last byte is a line break
          ASSERT_NE(error_of(bytes.substr(0, n)), "")
              << n << " of " << bytes.size() << " bytes pass";
    }

    TEST_F(MshFileTest, SaysWhereTheFileEnds)
    {
      const std::string ascii = version_2(two_tetrahedra_with_gaps(), false);
      expect_contains(
          error_of(ascii.substr(0, ascii.find("\n12 ") + 9)),
          "mesh.msh: ends within section $Nodes after 2 of 5 nodes; the file is truncated");
      expect_contains(error_of(ascii.substr(0, ascii.find("20 4 3 9"))),
                      "ends within section $Elements after 4 of 5 elements");
      expect_contains(error_of(ascii.substr(0, ascii.find("$Elements"))), "no section $Elements");
    }

    TEST_F(MshFileTest, SurvivesAnyDamagedByte)
    {
      // Whatever a byte becomes, reading ends, with a mesh or a UserError.
      for (const std::string &bytes : all_formats())
        for (std::size_t i = 0; i < bytes.size(); ++i)
          for (const char c : { '\xff', '7' })
          {
            std::string damaged = bytes;
            damaged[i]          = c;
            EXPECT_NO_THROW(error_of(damaged));
          }
    }

    TEST_F(MshFileTest, RefusesAbsurdCounts)
    {
      const std::string ascii = version_2(two_tetrahedra_with_gaps(), false);
      expect_contains(
          error_of(replaced(ascii, "$Nodes\n5\n", "$Nodes\n18446744073709551615\n")),
          "after 5 of 18446744073709551615 nodes: expected an integer, found '$EndNodes'");
      expect_contains(error_of(replaced(ascii, "$Nodes\n5\n", "$Nodes\n4\n")),
                      "expected $EndNodes");
      expect_contains(error_of(replaced(ascii, "$Elements\n5\n", "$Elements\n-5\n")),
                      "expected an integer, found '-5'");
      std::string binary = version_4(two_tetrahedra_with_gaps(), true);
      const auto  at     = binary.rfind("$Nodes\n") + 7;
      binary.replace(at + 8, 8, 8, '\xff'); // the total number of nodes
      expect_contains(error_of(binary), "the blocks hold 5, which is not the number announced");
      binary.replace(at, 8, 8, '\xff'); // the number of blocks
      EXPECT_NE(error_of(binary), "");
    }

    TEST_F(MshFileTest, RefusesDuplicateAndUnknownNodes)
    {
      MshFile duplicate         = two_tetrahedra_with_gaps();
      duplicate.node_numbers[4] = 12;
      MshFile    unknown        = two_tetrahedra_with_gaps();
      const auto file           = version_2(unknown, false);
      for (const bool binary : { false, true })
      {
        expect_contains(error_of(version_2(duplicate, binary)), "node number 12 appears twice");
        expect_contains(error_of(version_4(duplicate, binary)), "node number 12 appears twice");
      }
      expect_contains(error_of(replaced(file, "9 1 77 40 7 12 100000", "9 1 77 40 7 12 13")),
                      "element 21 uses node 13, which $Nodes does not have");
    }

    TEST_F(MshFileTest, RefusesCoordinatesThatAreNotFinite)
    {
      const auto file = version_2(two_tetrahedra_with_gaps(), false);
      for (const std::string bad : { "nan", "inf", "-inf", "1e999" })
        expect_contains(error_of(replaced(file, "12 0 0.1", "12 " + bad + " 0.1")), "node 12 has");
      EXPECT_EQ(error_of(replaced(file, "12 0 0.1", "12 +1e-999 0.1")), "");
      expect_contains(error_of(replaced(file, "12 0 0.1", "12 0x1 0.1")),
                      "expected a number, found '0x1'");
      MshFile msh     = two_tetrahedra_with_gaps();
      msh.nodes[3][1] = std::nan("");
      expect_contains(error_of(version_4(msh, true)), "node 100000 has");
    }

    TEST_F(MshFileTest, RefusesOtherFormats)
    {
      const auto file   = version_2(two_tetrahedra_with_gaps(), false);
      auto       binary = version_2(two_tetrahedra_with_gaps(), true);
      expect_contains(error_of(replaced(file, "2.2 0", "4 0")), "MSH version 4 is not supported");
      expect_contains(error_of(replaced(file, "0 8", "0 4")), "data size 8, found 0 and 4");
      expect_contains(error_of("solid cube\n"), "'solid'");
      expect_contains(error_of("$NOD\n1\n"), "begins with $MeshFormat");
      expect_contains(error_of(""), "begins with $MeshFormat");
      std::swap(binary[binary.find("1 8\n") + 4], binary[binary.find("1 8\n") + 7]);
      expect_contains(error_of(binary), "byte order");
      expect_contains(error_of(file + "$Nodes\n0\n$EndNodes\n"), "twice");
      expect_contains(error_of(file + "$ParametricNodes\n0\n"), "SaveParametric = 0");
      expect_contains(error_of(replaced(file, "21 4 3", "21 93 3")),
                      "element type 93 is not known");
    }

    TEST_F(MshFileTest, NamesMissingFile)
    {
      for (const auto &path : { directory / "nowhere.msh", directory })
        try
        {
          read_msh(path);
          ADD_FAILURE();
        }
        catch (const UserError &error)
        {
          expect_contains(error.what(), path.string() + ": cannot be opened");
        }
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
} // namespace Exemplar
