// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/filling/cell_angles.h>
#include <exemplar/surface/filling/surface_remeshing.h>
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_geometry.h>

#include "surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    double
    volume_of(const TetrahedralMesh &mesh, const unsigned int region)
    {
      double volume = 0.;
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      {
        const auto p = corners_of(mesh, c);
        EXPECT_GT(six_volumes(p[0], p[1], p[2], p[3]), 0.);
        volume += mesh.regions[c] == region ? six_volumes(p[0], p[1], p[2], p[3]) / 6. : 0.;
      }
      return volume;
    }

    TEST(Remeshing, KeepsEdgesAndGroups)
    {
      const TriangleSurface coarse = cube();
      const TriangleSurface fine   = remesh(coarse, .2, true);
      EXPECT_GT(fine.triangles.size(), 150U);
      EXPECT_NEAR(enclosed_volume(fine), 1., 1e-12);
      EXPECT_LT(distance_to(NearestTriangle(fine), coarse).maximum, 1e-12);
      EXPECT_TRUE(check_surface({ fine, {} }).faults.empty());
      double base = 0.;
      for (std::size_t t = 0; t < fine.triangles.size(); ++t)
        base += fine.groups[t] == 0 ? area_of(fine, t) : 0.;
      EXPECT_NEAR(base, 1., 1e-12);
    }

    TEST(Remeshing, KeepsTips)
    {
      // a thin pyramid on a fine base, coarsened to edges of twice its width
      TriangleSurface spike
          = triangulate({ { { { 0, 0, 0 } },
                            { { .1, 0, 0 } },
                            { { .1, .1, 0 } },
                            { { 0, .1, 0 } },
                            { { .05, .05, 1 } } },
                          { { 0, 3, 2, 1 }, { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } },
                          {},
                          {} });
      const TriangleSurface fine   = remesh(spike, .02, true);
      const TriangleSurface coarse = remesh(fine, .2, false);
      EXPECT_LT(coarse.triangles.size(), 80U);
      EXPECT_LT(NearestTriangle(coarse)({ { .05, .05, 1. } }).first, .01); // else .16
    }

    TEST(TetrahedraInside, FillRegionsAndLeaveCavities)
    {
      const TriangleSurface inner = cube({ { .25, .25, .25 } }, .5);
      const TetrahedralMesh two   = fill(remesh(joined(cube(), inner), .25, true));
      EXPECT_NEAR(volume_of(two, 0), .875, 1e-12);
      EXPECT_NEAR(volume_of(two, 1), .125, 1e-12);
      const TetrahedralMesh hollow = fill(remesh(joined(turned(inner), cube()), .25, true));
      EXPECT_NEAR(volume_of(hollow, 0), .875, 1e-12);
      EXPECT_EQ(volume_of(hollow, 1), 0.);
    }

    TEST(TetrahedraInside, BeginWithTheSurfacesVertices)
    {
      const TriangleSurface surface = remesh(cube(), .3, true);
      const TetrahedralMesh mesh    = fill(surface);
      ASSERT_GE(mesh.nodes.size(), surface.vertices.size());
      for (std::size_t i = 0; i < surface.vertices.size(); ++i)
        EXPECT_EQ(mesh.nodes[i], surface.vertices[i]);
      EXPECT_EQ(mesh.boundary.triangles, surface.triangles);
      EXPECT_EQ(fill(surface).nodes, mesh.nodes); // again: the same bytes
    }

    TEST(CellAngles, AreThoseOfKnownTetrahedra)
    {
      const auto [low, high] = dihedral_angles(
          { { { { 1, 1, 1 } }, { { 1, -1, -1 } }, { { -1, 1, -1 } }, { { -1, -1, 1 } } } });
      EXPECT_NEAR(low, std::acos(1. / 3.) * 180. / std::acos(-1.), 1e-12);
      EXPECT_NEAR(high, low, 1e-12);
      const auto corner = dihedral_angles(
          { { { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 0, 1, 0 } }, { { 0, 0, 1 } } } });
      EXPECT_NEAR(corner.first, std::acos(std::sqrt(1. / 3.)) * 180. / std::acos(-1.), 1e-12);
      EXPECT_NEAR(corner.second, 90., 1e-12);
    }

    /// A pyramid of two cells with a flat cell on its base, whose lower side is the boundary.
    TetrahedralMesh
    mesh_with_sliver()
    {
      TetrahedralMesh mesh;
      mesh.nodes              = { { { 0, 0, 0 } },
                                  { { 1, 0, -.001 } },
                                  { { 1, 1, 0 } },
                                  { { 0, 1, -.001 } },
                                  { { .5, .5, 1 } } };
      mesh.cells              = { { { 0, 1, 3, 4 } }, { { 1, 2, 3, 4 } }, { { 0, 1, 2, 3 } } };
      mesh.regions            = { 0, 0, 0 };
      mesh.boundary.triangles = { { { 0, 1, 4 } }, { { 1, 2, 4 } }, { { 2, 3, 4 } },
                                  { { 3, 0, 4 } }, { { 0, 2, 1 } }, { { 0, 3, 2 } } };
      mesh.boundary.groups.assign(6, 0);
      return mesh;
    }

    TEST(Slivers, OnTheBoundaryAreTakenAway)
    {
      TetrahedralMesh mesh   = mesh_with_sliver();
      CellAngles      angles = measure_angles(mesh);
      EXPECT_EQ(angles.n_boundary_slivers, 1U);
      EXPECT_EQ(remove_slivers(mesh, BoundaryNodes::kept), 1U);
      angles = measure_angles(mesh);
      EXPECT_EQ(angles.n_slivers, 0U);
      EXPECT_EQ(mesh.cells.size(), 2U);
      TriangleSurface boundary = mesh.boundary;
      boundary.vertices        = mesh.nodes;
      EXPECT_TRUE(check_surface({ boundary, {} }).faults.empty());
      EXPECT_NEAR(enclosed_volume(boundary), volume_of(mesh, 0), 1e-15);
    }

    TEST(Slivers, BetweenGroupsStay)
    {
      TetrahedralMesh mesh    = mesh_with_sliver();
      mesh.boundary.groups[5] = 1;
      EXPECT_EQ(remove_slivers(mesh, BoundaryNodes::kept), 0U);
      EXPECT_EQ(measure_angles(mesh).n_slivers, 1U);
    }

    TEST(Slivers, BoundaryNodesMoveSlightly)
    {
      TetrahedralMesh mesh    = mesh_with_sliver();
      mesh.boundary.groups[5] = 1;
      const auto before       = mesh.nodes;
      EXPECT_EQ(remove_slivers(mesh, BoundaryNodes::moved_slightly), 0U);
      EXPECT_EQ(measure_angles(mesh).n_slivers, 0U);
      for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LE(norm(minus(mesh.nodes[i], before[i])), 0.1001);
    }

    /// The same cells with a level base, whose nodes a selection may name.
    TEST(Slivers, NodesOnPlanesStay)
    {
      TetrahedralMesh mesh = mesh_with_sliver();
      for (unsigned int i = 0; i < 4; ++i)
        mesh.nodes[i][2] = i % 2 == 0 ? 0. : -1e-9;
      mesh.boundary.groups[5] = 1;
      const auto before       = mesh.nodes;
      remove_slivers(mesh, BoundaryNodes::moved_slightly);
      for (const unsigned int i : { 0U, 2U })
        EXPECT_EQ(mesh.nodes[i], before[i]);
    }
  } // namespace
} // namespace Exemplar::Testing
