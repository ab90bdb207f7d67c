// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/files/write_obj.h>

#include "expect_contains.h"
#include "surface_bytes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    using SurfaceFileTest = SurfaceTest;

    void
    expect_pyramid(const SurfaceMesh &surface)
    {
      EXPECT_EQ(surface.vertices, pyramid().vertices);
      EXPECT_EQ(surface.faces, pyramid().faces);
      EXPECT_EQ(surface.face_groups, pyramid().face_groups);
      EXPECT_EQ(surface.group_names, pyramid().group_names);
    }

    /// Of a good file: what it is changed to, and the message that this must give.
    struct Change
    {
      std::string from, to, message;
    };

    std::string
    replaced(std::string text, const std::string &from, const std::string &to)
    {
      const auto at = text.find(from);
      EXPECT_NE(at, std::string::npos) << from;
      return text.replace(at, from.size(), to);
    }

    TEST_F(SurfaceFileTest, ReadsObj)
    {
      expect_pyramid(read(obj_text, "a.obj"));
      std::string windows;
      for (const char c : obj_text)
        windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
      expect_pyramid(read(windows, "a.OBJ"));
    }

    TEST_F(SurfaceFileTest, TakesTheGroupsOfObjFromMaterialsAndObjectsToo)
    {
      std::string text = replaced(replaced(obj_text, "g 3\n", ""), "g 7\n", "");
      const auto  a_b  = read(text, "a.obj");
      EXPECT_EQ(a_b.group_names, (std::vector<std::string>{ "a", "b" }));
      EXPECT_EQ(a_b.face_groups, (std::vector<unsigned int>{ 0, 0, 1, 1, 1 }));
      text = replaced(replaced(text, "usemtl a\n", ""), "usemtl b\n", "");
      EXPECT_EQ(read(text, "a.obj").group_names, std::vector<std::string>{ "thing" });
      text = replaced(text, "o thing\n", "");
      EXPECT_TRUE(read(text, "a.obj").face_groups.empty());
    }

    TEST_F(SurfaceFileTest, ReadsPly)
    {
      expect_pyramid(read(ascii_ply(), "a.ply"));
      expect_pyramid(read(ascii_ply("\r\n"), "a.ply"));
      expect_pyramid(read(binary_ply(false), "a.ply"));
      expect_pyramid(read(binary_ply(true), "a.ply"));
    }

    std::string
    ascii_stl(const std::string &name, const std::vector<std::string> &corners)
    {
      std::string text = "solid " + name + "\n";
      for (std::size_t i = 0; i < corners.size(); ++i)
        text += (i % 3 == 0 ? "facet normal 0 0 0\n outer loop\n" : "") + ("vertex " + corners[i])
                + (i % 3 == 2 ? "\nendloop\nendfacet\n" : "\n");
      return text + "endsolid " + name + "\n";
    }

    const std::vector<std::string> tetrahedron{ "0 0 0",  "0 1 0", "1 0 0", "0 0 0",
                                                "1 0 0",  "0 0 1", "0 0 0", "0 0 1",
                                                "0 1 -0", "1 0 0", "0 1 0", "0 0 1" };

    TEST_F(SurfaceFileTest, ReadsAsciiStlAndJoinsEqualCorners)
    {
      const SurfaceMesh surface = read(ascii_stl("a b", tetrahedron), "a.stl");
      EXPECT_EQ(surface.vertices.size(), 4U);
      EXPECT_EQ(surface.faces, (std::vector<std::vector<unsigned int>>{
                                   { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 1 }, { 2, 1, 3 } }));
      EXPECT_EQ(surface.group_names, std::vector<std::string>{ "a b" });
      const std::vector<std::string> first(tetrahedron.begin(), tetrahedron.begin() + 3);
      const std::vector<std::string> others(tetrahedron.begin() + 3, tetrahedron.end());
      const SurfaceMesh two = read(ascii_stl("base", first) + ascii_stl("sides", others), "a.stl");
      EXPECT_EQ(two.face_groups, (std::vector<unsigned int>{ 0, 1, 1, 1 }));
    }

    /// With a header that begins as that of an ASCII file.
    std::string
    binary_stl(const unsigned int n_facets)
    {
      const auto  vertices = pyramid().vertices;
      std::string text     = "solid" + std::string(75, ' ') + number_bytes<std::uint32_t>(n_facets);
      for (std::size_t i = 0; i < 3 * n_facets; ++i)
      {
        if (i % 3 == 0)
          text += std::string(12, '\0');
        for (const double x : vertices[i % 4])
          text += number_bytes(static_cast<float>(x));
        if (i % 3 == 2)
          text += std::string(2, '\0');
      }
      return text;
    }

    TEST_F(SurfaceFileTest, ReadsBinaryStl)
    {
      const SurfaceMesh surface = read(binary_stl(2), "a.stl");
      EXPECT_EQ(surface.vertices.size(), 4U);
      EXPECT_EQ(surface.faces,
                (std::vector<std::vector<unsigned int>>{ { 0, 1, 2 }, { 3, 0, 1 } }));
      EXPECT_TRUE(surface.face_groups.empty());
    }

    TEST_F(SurfaceFileTest, WritesWhatItReads)
    {
      SurfaceMesh surface    = pyramid();
      surface.vertices[4][2] = 1.25 + 1. / 3.;
      surface.vertices[1][0] = -1e-300;
      write_obj(surface, directory / "b.obj");
      const SurfaceMesh again = read_surface(directory / "b.obj");
      EXPECT_EQ(again.vertices, surface.vertices);
      EXPECT_EQ(again.faces, surface.faces);
      EXPECT_EQ(again.face_groups, surface.face_groups);
      EXPECT_EQ(again.group_names, surface.group_names);
    }

    TEST_F(SurfaceFileTest, RefusesEveryTruncationOfBinaryFiles)
    {
      // what follows the faces may be missing: two numbers of an edge
      for (const bool big : { false, true })
        for (std::size_t n = 0; n < binary_ply(big).size(); ++n)
          ASSERT_NE(error_of(binary_ply(big).substr(0, n), "a.ply"), "") << n;
      for (std::size_t n = 0; n < binary_stl(2).size(); ++n)
        ASSERT_NE(error_of(binary_stl(2).substr(0, n), "a.stl"), "") << n;
      const std::string ply = binary_ply(false);
      expect_contains(error_of(ply.substr(0, ply.size() - 20), "a.ply"),
                      "ends after 4 of 5 elements of 'face'; the file is truncated");
      expect_contains(error_of(binary_stl(2) + "x", "a.stl"), "1 bytes follow the 2 facets");
    }

    TEST_F(SurfaceFileTest, SurvivesAnyDamagedByte)
    {
      const std::vector<std::pair<std::string, std::string>> files{ { obj_text, "a.obj" },
                                                                    { ascii_ply(), "a.ply" },
                                                                    { binary_ply(true), "a.ply" },
                                                                    { ascii_stl("s", tetrahedron),
                                                                      "a.stl" },
                                                                    { binary_stl(2), "a.stl" } };
      for (const auto &[bytes, name] : files)
        for (std::size_t i = 0; i < bytes.size(); ++i)
          for (const char c : { '\xff', '7', '\n' })
          {
            std::string damaged = bytes;
            damaged[i]          = c;
            EXPECT_NO_THROW(error_of(damaged, name)) << name << " byte " << i;
          }
    }

    TEST_F(SurfaceFileTest, NamesTheLineOfWhatIsWrong)
    {
      const std::vector<Change> cases{
        { "v 0 0 0\n", "v 0 x 0\n", "line 5: expected a number, found 'x'" },
        { "v 0 0 0\n", "v 0 0\n", "line 5: a vertex has three coordinates" },
        { "v 0 0 0\n", "v 0 0 nan\n", "vertex 1 of 5 has a coordinate that is no finite number" },
        { "v 0 0 0\n", "v 0 0 1e999\n", "vertex 1 of 5" },
        { "f 4 1 5", "f 4 1", "line 22: a face has at least three vertices, found 2" },
        { "f 4 1 5", "f 4 1 0", "line 22: a face uses vertex 0, but vertices are counted from 1" },
        { "f 4 1 5", "f 4 1 -6", "line 22: a face uses vertex -6, but there are 5" },
        { "f 4 1 5", "f 4 1 6", "line 22: a face uses vertex 6, but the file has 5 vertices" },
        { "f 4 1 5", "f 4 1 5.5", "line 22: expected an integer, found '5.5'" },
        { "f 4 1 5", "what 4 1 5", "line 22: expected a statement of an .obj file" },
        { "f 4 1 5", "surf 0 1", "line 22: free-form" },
      };
      for (const auto &[from, to, message] : cases)
        expect_contains(error_of(replaced(obj_text, from, to), "a.obj"), message);
    }

    TEST_F(SurfaceFileTest, NamesWhatIsWrongInPly)
    {
      const std::vector<Change> cases{
        { "0.1 1 1 0 255", "0.1 1 1 0", "line 24: the line ends after 4 numbers" },
        { "0.1 1 1 0 255", "0.1 1 1 0 255 1", "line 24: an element of 'vertex' has 5 numbers" },
        { "0.1 1 1 0 255", "0.1 1 inf 0 255", "vertex 3 of 5 has a coordinate" },
        { "3 3 0 4 0 7", "2 3 0 0 7", "face 5 has 2 vertices, at least three" },
        { "3 3 0 4 0 7", "3 3 0 5 0 7", "face 5 of 5 uses vertex 5 (counted from 0)" },
        { "3 3 0 4 0 7", "3 3 0 -1 0 7", "face 5 uses a vertex whose number" },
        { "3 3 0 4 0 7", "300 3 0 1 0 7", "announces more numbers than its line has" },
        { "ply", "plyx", "line 1: a .ply file begins with" },
        { "format ascii", "format text", "line 2: the format must be ascii" },
        { "property float y", "property float v", "no properties x, y and z" },
        { "vertex_indices", "vertices", "no list vertex_indices" },
        { "list uchar int", "list float int", "line 14: the length of a list" },
        { "element vertex 5", "element vertex 99999999999", "more than" },
        { "end_header", "endheader", "line 20: expected format, element" },
      };
      for (const auto &[from, to, message] : cases)
        expect_contains(error_of(replaced(ascii_ply(), from, to), "a.ply"), message);
    }

    TEST_F(SurfaceFileTest, NamesWhatIsNoSurface)
    {
      expect_contains(error_of("", "a.obj"), "the file is empty");
      expect_contains(error_of("v 0 0 0\n", "a.obj"), "1 vertices and 0 faces");
      expect_contains(error_of("v 0 0 0\n", "a.fbx"), "must be an .obj, .ply or .stl file");
      expect_contains(error_of("solid a\nfacet normal 0 0 1\n", "a.stl"), "it is truncated");
      expect_contains(error_of("solid a\nvertex 0 0 1\n", "a.stl"), "line 2: 'vertex' is not what");
      try
      {
        read_surface(directory / "none.ply");
        FAIL();
      }
      catch (const UserError &error)
      {
        expect_contains(error.what(), "cannot be opened");
      }
    }
  } // namespace
} // namespace Exemplar::Testing
