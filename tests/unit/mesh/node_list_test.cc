// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh_inputs.h>

#include "expect_contains.h"
#include "meshes.h"

#include <cstdint>
#include <cstring>
#include <vector>

namespace Exemplar::Testing
{
  namespace
  {
    using Nodes = std::vector<unsigned int>;

    class NodeListTest : public InTemporaryDirectory
    {
    protected:
      /// Of the nodes 10 to 14.
      Nodes
      read(const std::string &bytes) const
      {
        return read_nodes(write_file("list", bytes), two_tetrahedra(), "bar.msh", "KEY");
      }

      std::string
      refusal(const std::string &bytes) const
      {
        return error_of([&] { read(bytes); });
      }
    };

    /// What numpy.save() writes of a type for an array of a shape.
    template <typename Number>
    std::string
    npy(const std::string &type, const std::string &shape, const std::vector<Number> &numbers)
    {
      std::string header
          = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
      header.resize(117, ' ');
      header += '\n';
      std::string bytes = std::string("\x93NUMPY\x01\x00", 8);
      bytes += static_cast<char>(header.size());
      bytes += '\0';
      bytes += header;
      const std::size_t begin = bytes.size();
      bytes.resize(begin + numbers.size() * sizeof(Number));
      std::memcpy(bytes.data() + begin, numbers.data(), numbers.size() * sizeof(Number));
      return bytes;
    }

    TEST_F(NodeListTest, NumbersStandBetweenBlanksCommasAndComments)
    {
      for (const std::string list :
           { "10\n12\n", "12 10", "10,12", "10, 12,\r\n", "# nodes\n10 # first 99\n12", "10;12;10",
             "1.000000000000000000e+01\n1.200000000000000000e+01\n", "10.0 12.", "+10\t12#" })
        EXPECT_EQ(read(list), (Nodes{ 0, 2 })) << list;
    }

    TEST_F(NodeListTest, AWrongWordIsQuotedAlone)
    {
      for (const std::string word : { "9", "10.5", "-10", "ten", "nan", "inf", "0x0a", "1e1e1",
                                      "99999999999999999999", "1e300", "10-12" })
      {
        const std::string message = refusal("11, " + word + ", 12");
        expect_contains(message, "KEY: '" + word + "' in ");
        expect_contains(
            message,
            "list is no node number of bar.msh, whose nodes go up to 14. List node numbers");
      }
      EXPECT_LT(refusal(std::string(300000, 'x')).size(), 600u);
      expect_contains(refusal(" ,; # 10\n"), "holds no node number");
      expect_contains(error_of([&] { read_nodes(directory, two_tetrahedra(), "bar.msh", "KEY"); }),
                      "cannot be read");
    }

    TEST_F(NodeListTest, ArraysOfNumpyAreRead)
    {
      EXPECT_EQ(read(npy<std::int64_t>("<i8", "(2,)", { 12, 10 })), (Nodes{ 0, 2 }));
      EXPECT_EQ(read(npy<std::int32_t>("<i4", "(1, 2)", { 10, 12 })), (Nodes{ 0, 2 }));
      EXPECT_EQ(read(npy<std::uint16_t>("<u2", "(2, 1)", { 10, 12 })), (Nodes{ 0, 2 }));
      EXPECT_EQ(read(npy<double>("<f8", "(2,)", { 10., 12. })), (Nodes{ 0, 2 }));
      expect_contains(refusal(npy<std::int64_t>("<i8", "(2,)", { 10, 77 })), "'77'");
      expect_contains(refusal(npy<double>("<f8", "(1,)", { 10.5 })), "is no node number");
      expect_contains(refusal(npy<double>("<f8", "(1, 2)", { 10., 12. })), "such as coordinates");
      expect_contains(refusal(npy<char>("|b1", "(2,)", { 1, 0 })), "numpy.flatnonzero(mask) + 10)");
      expect_contains(refusal(npy<std::int64_t>(">i8", "(1,)", { 10 })), "byte order");
      expect_contains(refusal(npy<std::int64_t>("<i8", "(3,)", { 10, 11 })), "truncated");
      expect_contains(refusal(npy<std::int64_t>("<i8", "(0,)", {})), "holds no node number");
      const std::string whole = npy<std::int64_t>("<i8", "(1,)", { 10 });
      for (const std::size_t size : { 6, 9, 60, 130 })
        EXPECT_NE(refusal(whole.substr(0, size)), "") << size;
    }
  } // namespace
} // namespace Exemplar::Testing
