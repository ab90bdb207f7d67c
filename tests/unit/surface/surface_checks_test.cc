// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/surface_repair.h>
#include <exemplar/surface/shape/vectors.h>

#include "expect_contains.h"
#include "surfaces.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    std::string
    faults_of(const TriangleSurface &surface)
    {
      std::string text;
      for (const std::string &fault : check_surface({ surface, {} }).faults)
        text += fault + "\n";
      return text;
    }

    TEST(TriangleSurface, KeepsTheShapeOfPolygonsThatAreNotConvex)
    {
      // an L of area 3; a fan from its first vertex would cover more
      const SurfaceMesh         l{ { { { 2, 1, 0 } },
                                     { { 1, 1, 0 } },
                                     { { 1, 2, 0 } },
                                     { { 0, 2, 0 } },
                                     { { 0, 0, 0 } },
                                     { { 2, 0, 0 } } },
                           { { 0, 1, 2, 3, 4, 5 } },
                           {},
                           {} };
      std::vector<unsigned int> faces;
      const TriangleSurface     surface = triangulate(l, &faces);
      ASSERT_EQ(surface.triangles.size(), 4U);
      EXPECT_EQ(faces, (std::vector<unsigned int>{ 0, 0, 0, 0 }));
      double area = 0.;
      for (const auto &t : surface.triangles)
      {
        const double part = .5
                            * cross(minus(l.vertices[t[1]], l.vertices[t[0]]),
                                    minus(l.vertices[t[2]], l.vertices[t[0]]))[2];
        EXPECT_GT(part, 0.);
        area += part;
      }
      EXPECT_DOUBLE_EQ(area, 3.);
    }

    TEST(TriangleSurface, CutsDartsAtTheirNotch)
    {
      const SurfaceMesh dart{
        { { { 0, 0, 0 } }, { { 4, -2, 0 } }, { { 1, 0, 0 } }, { { 4, 2, 0 } } },
        { { 0, 1, 2, 3 } },
        {},
        {}
      };
      const TriangleSurface surface = triangulate(dart);
      ASSERT_EQ(surface.triangles.size(), 2U);
      EXPECT_DOUBLE_EQ(area_of(surface, 0), 1.); // the other cut has 8 and 6
      EXPECT_DOUBLE_EQ(area_of(surface, 1), 1.);
    }

    TEST(TriangleSurface, MeasuresVolume)
    {
      EXPECT_DOUBLE_EQ(enclosed_volume(cube()), 1.);
      EXPECT_DOUBLE_EQ(enclosed_volume(turned(cube())), -1.);
    }

    TEST(SurfaceChecks, AcceptsClosedSurfacesAndShellsWithinThem)
    {
      EXPECT_EQ(faults_of(cube()), "");
      EXPECT_EQ(faults_of(joined(cube(), cube({ { .25, .25, .25 } }, .5))), "");
      EXPECT_EQ(faults_of(joined(cube(), turned(cube({ { .25, .25, .25 } }, .5)))), "");
    }

    TEST(SurfaceChecks, FindsHoles)
    {
      TriangleSurface surface = cube();
      surface.triangles.pop_back();
      surface.triangles.erase(surface.triangles.begin());
      surface.groups.resize(surface.triangles.size());
      expect_contains(faults_of(surface),
                      "holes: 2 (with 6 open edges; the largest has 3, at vertex");
    }

    TEST(SurfaceChecks, FindsTurnedFaces)
    {
      TriangleSurface surface = cube();
      std::swap(surface.triangles[3][0], surface.triangles[3][1]);
      expect_contains(faults_of(surface), "faces turned against their neighbours: 1 (face 4)");
      EXPECT_EQ(turn_to_majority(surface), std::vector<unsigned int>{ 3 });
      EXPECT_EQ(faults_of(surface), "");
      expect_contains(faults_of(turned(cube())), "inside out");
    }

    TEST(SurfaceChecks, FindsOneSidedSurfaces)
    {
      // Moebius' strip of five triangles
      TriangleSurface strip;
      for (unsigned int i = 0; i < 5; ++i)
      {
        strip.vertices.push_back({ { std::cos(i * 1.2566), std::sin(i * 1.2566), .1 * i * i } });
        strip.triangles.push_back({ { i, (i + 1) % 5, (i + 2) % 5 } });
        strip.groups.push_back(0);
      }
      expect_contains(faults_of(strip), "one-sided");
    }

    TEST(SurfaceChecks, FindsCrowdedEdgesAndTouchingVertices)
    {
      TriangleSurface fin = cube();
      fin.vertices.push_back({ { -1, -1, 0 } });
      fin.triangles.push_back({ { 0, 1, 8 } });
      fin.groups.push_back(0);
      expect_contains(faults_of(fin), "edges of more than two faces: 1 (the first at vertex 1");

      // two cubes with a common corner
      TriangleSurface touching = joined(cube(), cube({ { 1, 1, 1 } }));
      for (auto &t : touching.triangles)
        for (unsigned int &vertex : t)
          vertex = vertex == 8 ? 7 : vertex;
      expect_contains(faults_of(touching),
                      "vertices where the surface touches itself: 1 (vertices 8;");
    }

    TEST(SurfaceChecks, FindsFlatFaces)
    {
      TriangleSurface surface = cube();
      surface.vertices[1]     = surface.vertices[0];
      expect_contains(faults_of(surface), "faces without area: 2 (faces ");
    }

    TEST(SurfaceChecks, FindsIntersectionsAndNotesShellsSideBySide)
    {
      const TriangleSurface crossing = joined(cube(), cube({ { .5, .5, .5 } }));
      expect_contains(faults_of(crossing), "pairs of intersecting faces: ");
      const auto findings = check_surface({ joined(cube(), cube({ { 2, 0, 0 } })), {} });
      EXPECT_TRUE(findings.faults.empty());
      ASSERT_EQ(findings.notes.size(), 1U);
      expect_contains(findings.notes[0], "2 shells side by side (12 triangles at");
    }

    TEST(SurfaceChecks, NotesVerticesThatDoNoHarm)
    {
      TriangleSurface surface = cube();
      surface.vertices.push_back(surface.vertices[2]);
      const auto findings = check_surface({ surface, {} });
      EXPECT_TRUE(findings.faults.empty());
      ASSERT_EQ(findings.notes.size(), 2U);
      expect_contains(findings.notes[0], "unused vertices: 1 (vertices 9)");
      expect_contains(findings.notes[1], "duplicate vertices: 1");
    }

    TEST(SurfaceGeometry, MeasuresDistances)
    {
      const NearestTriangle nearest(cube());
      EXPECT_DOUBLE_EQ(nearest({ { .5, .5, 3. } }).first, 2.);
      const SurfaceDistance distance = distance_to(nearest, cube({ { .25, .25, .25 } }, .5));
      EXPECT_DOUBLE_EQ(distance.maximum, .25);
      EXPECT_DOUBLE_EQ(distance.mean, .25);
      EXPECT_EQ(enclosing_shells(joined(cube({ { .25, .25, .25 } }, .5), cube()),
                                 std::vector<unsigned int>({ 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                             1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1 }),
                                 2),
                (std::vector<unsigned int>{ 1, 2 }));
    }

    TEST(SurfaceRepair, MendsWhatTheChecksFind)
    {
      TriangleSurface bad = cube();
      std::swap(bad.triangles[3][0], bad.triangles[3][1]);
      bad.triangles.pop_back();
      bad.triangles.push_back(bad.triangles[0]);
      bad.groups.assign(12, 5);
      const RepairedSurface repaired = repair(bad);
      EXPECT_EQ(faults_of(repaired.surface), "");
      EXPECT_NEAR(enclosed_volume(repaired.surface), 1., 1e-12);
      EXPECT_EQ(repaired.surface.groups,
                std::vector<unsigned int>(repaired.surface.triangles.size(), 5));
      EXPECT_FALSE(repaired.done.empty());
    }

    TEST(SurfaceRepair, WrapsWhatIntersects)
    {
      const TriangleSurface crossing = joined(cube(), cube({ { .5, .5, .5 } }));
      const TriangleSurface wrapped  = wrap(crossing, .03);
      EXPECT_EQ(faults_of(wrapped), "");
      EXPECT_NEAR(enclosed_volume(wrapped), 2. - .125, .07);
    }
  } // namespace
} // namespace Exemplar::Testing
