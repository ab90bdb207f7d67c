// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/physical_names.h>
#include <exemplar/mesh/selection.h>

#include "expect_contains.h"
#include "meshes.h"

namespace Exemplar::Testing
{
  namespace
  {
    /// Tag 5 is the volume "soft tissue", 6 (of the file -6) "bone", 7 the surface "left".
    MshFile
    named_tetrahedra()
    {
      MshFile msh        = two_tetrahedra();
      msh.physical_names = {
        { { 3, 5 }, "soft tissue" }, { { 3, -6 }, "bone" }, { { 2, 7 }, "left" }, { { 2, 8 }, "8" }
      };
      return msh;
    }

    TEST(PhysicalNames, AreIdsOrNames)
    {
      const MshFile msh = named_tetrahedra();
      EXPECT_EQ(find_id(msh, 3, "17", "KEY"), 17u);
      EXPECT_EQ(find_id(msh, 3, "soft tissue", "KEY"), 5u);
      EXPECT_EQ(find_id(msh, 3, "\"soft tissue\"", "KEY"), 5u);
      EXPECT_EQ(find_id(msh, 3, "bone", "KEY"), 6u);
      EXPECT_EQ(find_id(msh, 2, "\"8\"", "KEY"), 8u);
      const auto error = [&](const std::string &text)
      { return error_of([&] { find_id(msh, 2, text, "KEY"); }); };
      expect_contains(error("bone"), "KEY: the mesh has no Physical Surface of the name 'bone' "
                                     "(present: 'left', '8').");
      for (const std::string wrong : { "1.5", "-1", "1e20", "nan" })
        expect_contains(error(wrong), "an id is a whole number");
      MshFile twice                         = named_tetrahedra();
      twice.physical_names[std::pair(2, 9)] = "left";
      expect_contains(error_of([&] { find_id(twice, 2, "left", "KEY"); }), "several");
    }

    TEST(PhysicalNames, SelectAsIdsDo)
    {
      const Mesh mesh(named_tetrahedra(), "bar.msh");
      const auto nodes
          = [&](const std::string &text) { return Selection{ text }.nodes(mesh, "KEY"); };
      EXPECT_EQ(nodes("region soft tissue"), nodes("region 5"));
      EXPECT_EQ(nodes("region \"bone\""), nodes("region 6"));
      EXPECT_EQ(nodes("boundary left"), nodes("boundary 7"));
      expect_contains(error_of([&] { nodes("region left"); }),
                      "KEY = 'region left': the mesh");
    }
  } // namespace
} // namespace Exemplar::Testing
