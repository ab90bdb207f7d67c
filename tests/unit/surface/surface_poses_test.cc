// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/surface/files/numbered_files.h>
#include <exemplar/surface/shape/surface_poses.h>

#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace Exemplar::Testing
{
  namespace
  {
    std::string
    complaint(const std::function<void()> &action)
    {
      try
      {
        action();
      }
      catch (const UserError &error)
      {
        return error.what();
      }
      return "";
    }

    /// A box of six quadrilaterals that look outwards, 1 x 2 x 3.
    SurfaceMesh
    box()
    {
      SurfaceMesh surface;
      for (int v = 0; v < 8; ++v)
        surface.vertices.push_back({ { 1. * (v & 1), 1. * (v & 2), 0.75 * (v & 4) } });
      surface.faces = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
                        { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
      return surface;
    }

    SurfaceMesh
    mapped(SurfaceMesh surface, const std::function<void(SurfaceMesh::Vertex &)> &map)
    {
      for (auto &x : surface.vertices)
        map(x);
      return surface;
    }

    std::string
    order_complaint(const SurfaceMesh &pose)
    {
      return complaint([&] { check_same_order(box(), "rest.obj", pose, "p.obj"); });
    }

    std::string
    pose_complaint(const SurfaceMesh &pose)
    {
      return complaint([&] { check_pose(box(), "rest.obj", pose, "p.obj"); });
    }

    TEST(SurfacePoses, AnotherOrderIsSaidWithItsFirstDifference)
    {
      EXPECT_EQ(order_complaint(box()), "");
      SurfaceMesh more = box();
      more.vertices.push_back({});
      EXPECT_EQ(order_complaint(more).find(
                    "p.obj is no pose of rest.obj: it has 9 vertices, the surface at rest 8."),
                0u);
      SurfaceMesh fewer = box();
      fewer.faces.pop_back();
      EXPECT_NE(order_complaint(fewer).find("5 faces, the surface at rest 6."), std::string::npos);
      SurfaceMesh other = box();
      std::swap(other.faces[3][1], other.faces[3][2]);
      EXPECT_NE(order_complaint(other).find("face 4 has the vertices 3 8 7 4, at rest 3 7 8 4."),
                std::string::npos);
    }

    TEST(SurfacePoses, UnitsAndMirrorImagesAreNamed)
    {
      EXPECT_EQ(pose_complaint(box()), "");
      EXPECT_NE(pose_complaint(mapped(box(),
                                      [](auto &x)
                                      {
                                        for (double &c : x)
                                          c *= 1000.;
                                      }))
                    .find("1000 times larger"),
                std::string::npos);
      EXPECT_NE(pose_complaint(mapped(box(),
                                      [](auto &x)
                                      {
                                        for (double &c : x)
                                          c *= 1e-3;
                                      }))
                    .find("1000 times smaller"),
                std::string::npos);
      EXPECT_NE(pose_complaint(mapped(box(), [](auto &x) { x[1] = -x[1]; })).find("mirror image"),
                std::string::npos);
      EXPECT_EQ(pose_complaint(mapped(box(), [](auto &x) { x = { { -x[1], x[0], x[2] } }; })), "");
      // sheared and stretched, but not turned inside out
      EXPECT_EQ(pose_complaint(mapped(box(), [](auto &x) { x[0] = 2. * x[0] + x[2]; })), "");
    }

    TEST(SurfacePoses, CoordinatesThatAreNoneAreRefused)
    {
      EXPECT_EQ(complaint([] { require_surface(box(), "p.obj"); }), "");
      SurfaceMesh bad    = box();
      bad.vertices[5][1] = std::nan("");
      EXPECT_EQ(complaint([&] { require_surface(bad, "p.obj"); }).find("p.obj: vertex 6 "), 0u);
      const SurfaceMesh flat = mapped(box(), [](auto &x) { x = { { 1., 2., 3. } }; });
      EXPECT_NE(complaint([&] { require_surface(flat, "p.obj"); }).find("without area"),
                std::string::npos);
    }

    TEST(SurfacePoses, ThePoseAtRestIsKnown)
    {
      EXPECT_TRUE(is_at_rest(box(), box()));
      EXPECT_FALSE(is_at_rest(box(), mapped(box(), [](auto &x) { x[0] += 1e-3; })));
    }

    TEST(NumberedFiles, NumbersCountAsNumbers)
    {
      EXPECT_TRUE(comes_before("walk_9.obj", "walk_10.obj"));
      EXPECT_FALSE(comes_before("walk_10.obj", "walk_9.obj"));
      EXPECT_TRUE(comes_before("walk_009.obj", "walk_10.obj"));
      EXPECT_TRUE(comes_before("walk_9", "walk_9b"));
      EXPECT_TRUE(comes_before("a2_10", "a10_2"));
      EXPECT_NE(comes_before("a01", "a1"), comes_before("a1", "a01"));
      EXPECT_FALSE(comes_before("a1", "a1"));
    }

    class NumberedFilesTest : public InTemporaryDirectory
    {
    };

    TEST_F(NumberedFilesTest, PatternsStandForFilesInTheOrderOfTheirNumbers)
    {
      for (const char *name : { "walk_10.obj", "walk_9.obj", "walk_1.obj", "run_2.obj" })
        write_file(name, "");
      const auto files = expand_patterns({ "other.obj", (directory / "walk_*.obj").string() });
      ASSERT_EQ(files.size(), 4u);
      EXPECT_EQ(files[0], "other.obj");
      EXPECT_EQ(files[2], directory / "walk_9.obj");
      EXPECT_EQ(files[3], directory / "walk_10.obj");
      EXPECT_NE(complaint([&] { expand_patterns({ (directory / "hop_*.obj").string() }); })
                    .find("No file matches"),
                std::string::npos);
    }
  } // namespace
} // namespace Exemplar::Testing
