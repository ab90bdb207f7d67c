// SPDX-License-Identifier: GPL-3.0-or-later
#include "expect_contains.h"
#include "msh_bytes.h"

#include <gtest/gtest.h>

#include <limits>

namespace Exemplar::Testing
{
  namespace
  {
    using MshDamageTest = MshTest;

    TEST_F(MshDamageTest, RefusesEveryTruncation)
    {
      for (const std::string &bytes : all_formats())
        for (std::size_t n = 0; n + 1 < bytes.size(); ++n) // the last byte is a line break
          ASSERT_NE(error_of(bytes.substr(0, n)), "")
              << n << " of " << bytes.size() << " bytes pass";
    }

    TEST_F(MshDamageTest, SaysWhereTheFileEnds)
    {
      const std::string ascii = version_2(two_tetrahedra_with_gaps(), false);
      expect_contains(
          error_of(ascii.substr(0, ascii.find("\n12 ") + 9)),
          "mesh.msh: ends within section $Nodes after 2 of 5 nodes; the file is truncated");
      expect_contains(error_of(ascii.substr(0, ascii.find("20 4 3 9"))),
                      "ends within section $Elements after 4 of 5 elements");
      expect_contains(error_of(ascii.substr(0, ascii.find("$Elements"))), "no section $Elements");
    }

    TEST_F(MshDamageTest, SurvivesAnyDamagedByte)
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

    TEST_F(MshDamageTest, RefusesAbsurdCounts)
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

    TEST_F(MshDamageTest, RefusesDuplicateAndUnknownNodes)
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

    TEST_F(MshDamageTest, RefusesCoordinatesThatAreNotFinite)
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

    TEST_F(MshDamageTest, RefusesATagWithoutAMagnitude)
    {
      const std::string message = "a tag of -2147483648 is not allowed";
      MshFile           msh     = two_tetrahedra_with_gaps();
      const auto        file    = version_4(msh, false);
      expect_contains(error_of(replaced(file, "2 8 1 1 3", "2 -2147483648 1 1 3")), message);
      expect_contains(error_of(replaced(file, "2 8 \"left", "2 -2147483648 \"left")), message);
      msh.elements[2].physical = std::numeric_limits<int>::min();
      for (const bool binary : { false, true })
        expect_contains(error_of(version_2(msh, binary)), message);
    }

    TEST_F(MshDamageTest, RefusesOtherFormats)
    {
      const auto file   = version_2(two_tetrahedra_with_gaps(), false);
      auto       binary = version_2(two_tetrahedra_with_gaps(), true);
      expect_contains(error_of(replaced(file, "2.2 0", "4 0")), "MSH version 4 is not supported");
      expect_contains(error_of(replaced(file, "0 8", "0 4")), "data size 8, found 0 and 4");
      expect_contains(error_of("solid cube\n"), "an STL surface");
      expect_contains(error_of("$NOD\n1\n"), "begins with $MeshFormat");
      expect_contains(error_of(""), "the file is empty");
      std::swap(binary[binary.find("1 8\n") + 4], binary[binary.find("1 8\n") + 7]);
      expect_contains(error_of(binary), "byte order");
      expect_contains(error_of(file + "$Nodes\n0\n$EndNodes\n"), "twice");
      expect_contains(error_of(file + "$ParametricNodes\n0\n"), "SaveParametric = 0");
      expect_contains(error_of(replaced(file, "21 4 3", "21 93 3")),
                      "element type 93 is not known");
    }

    TEST_F(MshDamageTest, NamesMissingFile)
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
  } // namespace
} // namespace Exemplar::Testing
