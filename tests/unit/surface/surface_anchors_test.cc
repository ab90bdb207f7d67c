// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/vectors.h>
#include <exemplar/surface/skin/surface_anchors.h>
#include <exemplar/surface/skin/surface_skin.h>

#include "fold_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace Exemplar::Testing
{
  namespace
  {
    /// The bar from x = 1 on split into two limbs, z > 0.1 and z < -0.1.
    Mesh
    forked_bar()
    {
      const Mesh                               bar = small_bar(5);
      std::vector<std::array<unsigned int, 4>> cells;
      std::map<unsigned int, unsigned int>     number;
      std::vector<dealii::Point<3>>            nodes;
      for (auto cell : bar.get_cells())
      {
        dealii::Point<3> middle;
        for (const unsigned int node : cell)
          middle += .25 * bar.get_nodes()[node];
        if (middle[0] > 1. && std::abs(middle[2]) < .1)
          continue;
        for (unsigned int &node : cell)
        {
          const auto added = number.emplace(node, nodes.size());
          if (added.second)
            nodes.push_back(bar.get_nodes()[node]);
          node = added.first->second;
        }
        cells.push_back(cell);
      }
      return Mesh(make_msh(nodes, cells), "fork.msh");
    }

    TEST(SurfaceAnchors, AVertexStaysOnItsLimbWhereAnotherIsNearer)
    {
      const Mesh fork = forked_bar();
      for (const double z : { -.06, -.14 }) // nearer to the other limb, inside it
        for (const bool inside_out : { false, true })
        {
          SurfaceMesh              surface = boundary_as_surface(fork);
          std::vector<std::size_t> moved;
          for (std::size_t v = 0; v < surface.vertices.size(); ++v)
            if (auto &x = surface.vertices[v];
                x[0] > 1.3 && x[0] < 3.9 && std::abs(x[1]) < .4 && std::abs(x[2] - .1) < 1e-9)
            {
              x[2] = z;
              moved.push_back(v);
            }
          if (inside_out)
            for (auto &face : surface.faces)
              std::swap(face[0], face[1]);
          ASSERT_GT(moved.size(), 10u);
          const auto anchors = find_anchors(surface, fork);
          for (const std::size_t v : moved)
          {
            const auto &x = surface.vertices[v];
            // the edge of what has moved is steep, and faces other ways
            if (x[0] > 1.5 && x[0] < 3.7 && std::abs(x[1]) < .2)
            {
              EXPECT_NEAR(anchors[v].place[2], .1, 1e-9);
            }
          }
        }
    }

    /// The forked bar with its limbs bent so that they cross: z becomes z - 2 c (x - 1)^2 / 9 for
    /// z > 0.1 and z + ... for z < -0.1, c the depth of the crossing at the ends.
    Mesh
    crossing_fork(const double depth, std::vector<SurfaceTie> ties)
    {
      const Mesh fork     = forked_bar();
      MshFile    contents = fork.get_contents();
      for (dealii::Point<3> &x : contents.nodes)
        if (x[0] > 1. && std::abs(x[2]) > .05)
          x[2] -= (x[2] > 0. ? 1. : -1.) * (.1 + depth) * std::pow((x[0] - 1.) / 3., 2);
      contents.surface_ties = std::move(ties);
      return Mesh(contents, "crossing.msh");
    }

    TEST(SurfaceAnchors, LipsThatCrossFollowEachItsOwnSideByTiesMadeWhereTheyWereApart)
    {
      const Mesh open = forked_bar();
      const auto ties = make_ties(boundary_as_surface(open), open);
      for (const double depth : { -.05, 0., .05, .15 })
      {
        const Mesh        shut    = crossing_fork(depth, ties);
        const SurfaceMesh surface = boundary_as_surface(shut);
        const SurfaceSkin skin(surface, shut);
        // the upper limb rises by w (x - 1)^2 / 9, the lower one sinks: quadratic on each side
        constexpr double w = .5;
        Vector           displacement(3 * shut.n_nodes());
        const auto       rise = [&](const dealii::Point<3> &x)
        { return x[0] > 1. ? w * std::pow((x[0] - 1.) / 3., 2) : 0.; };
        for (unsigned int i = 0; i < shut.n_nodes(); ++i)
        {
          const double side       = open.get_nodes()[i][2] > .05    ? 1.
                                    : open.get_nodes()[i][2] < -.05 ? -1.
                                                                    : 0.;
          displacement[3 * i + 2] = side * rise(shut.get_nodes()[i]);
        }
        const auto places = skin.carry(displacement);
        for (std::size_t v = 0; v < places.size(); ++v)
          EXPECT_NEAR(places[v][2], surface.vertices[v][2] + displacement[3 * v + 2], 1e-6 * w)
              << depth << ' ' << v;
        for (const auto &face : surface.faces)
          for (std::size_t i = 0; i < face.size(); ++i)
          {
            const unsigned int a = face[i], b = face[(i + 1) % face.size()];
            const auto         end = [&](const unsigned int v)
            { return shut.get_nodes()[v][2] + displacement[3 * v + 2]; };
            const double own
                = std::hypot(surface.vertices[a][0] - surface.vertices[b][0],
                             surface.vertices[a][1] - surface.vertices[b][1], end(a) - end(b));
            EXPECT_LT(norm(minus(places[a], places[b])), 1.01 * own);
          }
      }
    }

    TEST(SurfaceAnchors, TiesOfAnotherSurfaceAreNotTaken)
    {
      const Mesh              fork = forked_bar();
      std::vector<SurfaceTie> ties = make_ties(boundary_as_surface(fork), fork);
      for (SurfaceTie &tie : ties)
        tie = { { { 0, 0, 0, 0 } }, { { 1., 0., 0., 0. } } }; // all at one end
      MshFile contents      = fork.get_contents();
      contents.surface_ties = ties;
      const Mesh far(contents, "far.msh");
      contents.surface_ties.pop_back();
      const Mesh        few(contents, "few.msh");
      const SurfaceMesh surface  = boundary_as_surface(fork);
      const auto        expected = find_anchors(surface, fork);
      for (const Mesh *const mesh : { &far, &few })
      {
        const auto found = find_anchors(surface, *mesh);
        for (std::size_t v = 0; v < expected.size(); ++v)
          EXPECT_EQ(found[v].nodes, expected[v].nodes);
      }
    }

    TEST(SurfaceAnchors, AVertexOnAnInnerShellStaysInItsCell)
    {
      // a shell inside a bar, its faces looking inwards as those of a cavity do
      const Mesh  bar   = small_bar(3);
      SurfaceMesh shell = boundary_as_surface(small_bar(2));
      for (auto &x : shell.vertices)
        x = { { .2 + .9 * x[0], .7 * x[1], .7 * x[2] } };
      SurfaceMesh    both = boundary_as_surface(bar);
      const unsigned n    = both.vertices.size();
      both.vertices.insert(both.vertices.end(), shell.vertices.begin(), shell.vertices.end());
      for (const auto &face : shell.faces)
        both.faces.push_back({ n + face[1], n + face[0], n + face[2] });
      const auto anchors = find_anchors(both, bar);
      for (std::size_t v = 0; v < both.vertices.size(); ++v)
        for (unsigned int c = 0; c < 3; ++c)
          EXPECT_NEAR(anchors[v].place[c], both.vertices[v][c], 1e-12);
    }
  } // namespace
} // namespace Exemplar::Testing
